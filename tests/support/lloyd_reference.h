// Lloyd's iteration written plainly: every node is compared with every site in every pass, on one thread.
// What the product leaves out must not change a bit of this.
#pragma once

#include <cmath>
#include <limits>
#include <random>

#include "cvd/cvd.h"

namespace sherd::reference {

/// The documented order of summation: component i to partial sum i mod 8.
inline double squaredDistance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double s[8] = {};
  for (Eigen::Index i = 0; i < a.size(); ++i) s[i % 8] += (a[i] - b[i]) * (a[i] - b[i]);
  return ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]));
}

struct PlainLloyd {
  const Eigen::MatrixXd& x;
  const WeightField& weights;
  Eigen::MatrixXd sites;
  std::vector<Index> label;
  std::vector<double> distance2;

  bool assign() {
    const std::vector<Index> before = label;
    label.assign(static_cast<std::size_t>(x.cols()), 0);
    distance2.assign(label.size(), std::numeric_limits<double>::infinity());
    for (std::size_t n = 0; n < label.size(); ++n)
      for (Eigen::Index j = 0; j < sites.cols(); ++j) {
        const double d = squaredDistance(x.col(static_cast<Eigen::Index>(n)), sites.col(j));
        if (d < distance2[n]) distance2[n] = d, label[n] = static_cast<Index>(j);
      }
    return label != before;
  }
  double move(double relaxation = 1) {
    double farthest = 0;
    for (Eigen::Index j = 0; j < sites.cols(); ++j)
      for (const auto* by : {&weights.weight, &weights.volume}) {
        // The documented order: blocks of sixteen nodes, and within them node by node.
        double total = 0;
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.rows());
        for (std::size_t first = 0; first < label.size(); first += 16) {
          double blockTotal = 0;
          Eigen::VectorXd blockSum = Eigen::VectorXd::Zero(x.rows());
          for (std::size_t n = first; n < std::min(first + 16, label.size()); ++n) {
            if (label[n] != j) continue;
            blockTotal += (*by)[n];
            for (Eigen::Index i = 0; i < x.rows(); ++i)
              blockSum[i] += (*by)[n] * x(i, static_cast<Eigen::Index>(n));
          }
          total += blockTotal;
          sum += blockSum;
        }
        if (!(total > 0)) continue;
        sum /= total;
        if (relaxation != 1) sum = sites.col(j) + relaxation * (sum - sites.col(j));
        farthest = std::max(farthest, std::sqrt(squaredDistance(sum, sites.col(j))));
        sites.col(j) = sum;
        break;
      }
    return farthest;
  }
  Lloyd::End run(const LloydLimits& limits, double diameter) {
    Lloyd::End end;
    double relaxation = limits.relaxation;
    while (!end.converged && end.iterations < limits.maxIterations) {
      const std::vector<Index> before = label;
      const double step = move(relaxation);
      assign();
      ++end.iterations;
      std::size_t changed = 0;
      for (std::size_t n = 0; n < label.size(); ++n) changed += label[n] != before[n];
      if (relaxation == 1)
        end.converged = changed == 0 || step <= limits.tolerance * diameter;
      else if (100 * changed <= label.size())
        relaxation = 1;
    }
    return end;
  }
  double energy() const {
    double sum = 0;
    for (std::size_t n = 0; n < label.size(); ++n) sum += weights.weight[n] * distance2[n];
    return sum;
  }
};

/// A seeded cloud that thins out along its dimensions, as embeddings do, with weights over several decades.
struct Cloud {
  std::shared_ptr<Embedding> embedding = std::make_shared<Embedding>();
  WeightField weights;
};

inline void measure(Embedding& e) {
  e.diameter = (e.coordinates.rowwise().maxCoeff() - e.coordinates.rowwise().minCoeff()).norm();
}

inline Cloud cloud(int nodes, int dimensions, unsigned seed) {
  std::mt19937_64 random(seed);
  auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Cloud c;
  c.embedding->coordinates.resize(dimensions, nodes);
  for (int n = 0; n < nodes; ++n) {
    for (int i = 0; i < dimensions; ++i) c.embedding->coordinates(i, n) = (uniform() - 0.5) / (1 + i);
    c.weights.weight.push_back(std::pow(10.0, 4 * uniform() - 4));
    c.weights.volume.push_back(0.5 + uniform());
  }
  measure(*c.embedding);
  return c;
}

}  // namespace sherd::reference
