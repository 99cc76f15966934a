// What the benchmarks of cells run: bodies, ways to start, and Lloyd's iteration from there.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cvd/cvd.h"

namespace sherd::bench {

struct Body {
  std::shared_ptr<const Embedding> embedding;
  WeightField weights;
};

/// What a run ended with.
struct Outcome {
  double energy = 0;
  int iterations = 0;
  std::vector<Index> labels;
};

struct PaperCase {
  const char* name;
  const char* file;
  int tets, sites;
  double goal;     ///< ms
  int dimensions;  ///< of the paper's embedding; 3: positions

  std::string path() const;
};
/// The paper's models and numbers of sites.
std::vector<PaperCase> paperCases();
/// The case's body in the embedding that graphs have by default, all volumes as weights.
Body bodyOf(const PaperCase& c);
/// The same in as many dimensions as the paper's: the lowest modes of the cage's surface, carried inward by
/// mean value coordinates, under a diffusion filter of so short a time that all of them count.
Body bodyInPaperDimensions(const PaperCase& c);

/// Points in a box of five dimensions or more, all but three of which bend; in the order in which
/// Tetrahedralize numbers nodes, along a Morton curve. All weigh 1.
Body cloud(std::size_t nodes, Eigen::Index dimensions);

/// Strain energy falls off from where a body is hit: weights by distance from the first corner of its box.
WeightField hitAtACorner(const WeightField& volumes);

/// Nodes drawn with probability ∝ amount, each on its own.
Lloyd drawnAtOnce(const Body& body, const std::vector<double>& amount, int count, std::uint64_t seed);
/// Each ∝ w d² to those before, without an iteration between.
Lloyd drawnApart(const Body& body, int count, std::int64_t seed);
/// To the end of the iteration.
Outcome iterated(Lloyd lloyd, Labels labels = Labels::Exact, const LloydLimits& limits = {});
/// Grown from one, a few passes after each, and then to the end.
Outcome grown(const Body& body, int count, std::int64_t seed);

double shareOfDifferent(const std::vector<Index>& a, const std::vector<Index>& b);

}  // namespace sherd::bench
