// The parts of bench_learn. Each returns what it has to say, in Markdown.
#pragma once

#include <filesystem>
#include <string>

#include "bench/learning.h"

namespace sherd::bench {

struct Setup {
  Body body;
  TrainDegreeParams params;
  DropExamples training, tests;
  double trainingSeconds = 0;
};

/// Methods beside each other on orientations that they weren't made of; CSV into `out`.
std::string methodsPart(const Setup& setup, const std::filesystem::path& out);
/// Figures 8 and 9 as SVG and CSV into `directory`.
std::string figuresPart(const Setup& setup, const std::filesystem::path& directory);
/// A model made of drops on thrown balls, beside one made of balls.
std::string ballsPart(const Setup& setup, const BallParams& balls);
/// Foretelling beside searching on the same hits: times, degrees, and E_D against γ.
std::string hitsPart(const Setup& setup);
/// The columns of the paper's Tables 1 and 2, ours beside the paper's.
std::string paperPart();

/// The default's parameters and the paper's.
inline LearnDegreeParams bestMethod() { return {}; }
inline LearnDegreeParams paperMethod(double tolerance = 0.02) {
  return {DegreeMethod::Network, tolerance, 0.01};
}

}  // namespace sherd::bench
