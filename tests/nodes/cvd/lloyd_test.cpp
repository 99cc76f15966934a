// Lloyd's iteration through any history, and where it is told to end.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "base/rng.h"
#include "cvd/cvd.h"
#include "support/lloyd_reference.h"

namespace sherd {
namespace {

using reference::Cloud;
using reference::cloud;
using reference::PlainLloyd;

TEST(Lloyd, AnyHistoryHasTheBitsOfThePlainReference) {
  const Rng rng(23);
  for (std::uint64_t i = 0; i < 120; ++i) {
    const auto draw = [&](std::uint64_t k, std::uint64_t below) {
      return static_cast<int>(rng.uniformAt(64 * i + k) * static_cast<double>(below));
    };
    Cloud c = cloud(2 + draw(0, 400), 1 + draw(1, 20), static_cast<unsigned>(i));
    Eigen::MatrixXd& x = c.embedding->coordinates;
    if (draw(2, 3) == 0) x.leftCols(x.cols() / 2) *= 1e-9;  // a cluster
    if (draw(3, 3) == 0) x.array() += 1e6 * c.embedding->diameter;
    if (draw(4, 4) == 0) x.rightCols(x.cols() / 3) = x.leftCols(x.cols() / 3);  // twice at one place
    if (draw(5, 4) == 0) std::fill_n(c.weights.weight.begin(), c.weights.weight.size() / 2, 0.0);
    reference::measure(*c.embedding);
    Lloyd lloyd(*c.embedding, c.weights);
    PlainLloyd plain{x, c.weights, {}, {}, {}};
    plain.sites.resize(x.rows(), 0);
    for (std::uint64_t step = 0; step < 25; ++step) {
      if (step > 0 && draw(6 + 2 * step, 3) == 0) {
        const LloydLimits few{.maxIterations = 1 + draw(7 + 2 * step, 4)};
        ASSERT_TRUE(lloyd.run(few, Exec{}).ok());
        plain.run(few, c.embedding->diameter);
      } else {
        plain.sites.conservativeResize(Eigen::NoChange, plain.sites.cols() + 1);
        plain.sites.rightCols(1) = x.col(draw(7 + 2 * step, static_cast<std::uint64_t>(x.cols())));
        lloyd.addSite(plain.sites.rightCols(1), Exec{});
        plain.assign();
      }
      ASSERT_EQ(lloyd.labels(), plain.label) << "case " << i << ", step " << step;
      ASSERT_EQ(lloyd.sites(), plain.sites) << "case " << i << ", step " << step;
      ASSERT_EQ(lloyd.energy(), plain.energy()) << "case " << i << ", step " << step;
    }
  }
}

TEST(Lloyd, SitesBeyondFloatsLeaveTheNodesToOthers) {
  for (const int nodes : {50, 90'000}) {  // few pairs of node and site, and many
    Cloud c = cloud(nodes, 2, 1);
    Lloyd lloyd(*c.embedding, c.weights);
    for (const double place : {1e40, 2e40, 0.0}) lloyd.addSite(Eigen::Vector2d::Constant(place), Exec{});
    EXPECT_EQ(std::count(lloyd.labels().begin(), lloyd.labels().end(), 2), nodes);
    ASSERT_TRUE(lloyd.run({}, Exec{}).ok());
    EXPECT_EQ(std::count(lloyd.labels().begin(), lloyd.labels().end(), 2), nodes);
  }
}

TEST(Cvd, CanBeCancelledAmongManySites) {
  const Cloud c = cloud(60'000, 3, 1);
  Sites start;
  start.positions = c.embedding->coordinates.leftCols(4000);
  CancelToken token;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    token.cancel();
  });
  Exec exec;
  exec.cancel = &token;
  const auto result = cvd(c.embedding, c.weights, &start, {}, exec);
  later.join();
  ASSERT_FALSE(result.ok());
  EXPECT_TRUE(result.error().kind == Error::Kind::Cancelled);
}

TEST(Cvd, RefusesBodiesWhoseSquaresAreNoNumbers) {
  for (const double scale : {1e-160, 1e160}) {
    Cloud c = cloud(30, 3, 1);
    c.embedding->coordinates *= scale;
    c.embedding->diameter *= scale;
    const auto result = cvd(c.embedding, c.weights, nullptr, {.degree = 3}, Exec{});
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().text().find("m wide"), std::string::npos) << result.error().text();
  }
}

}  // namespace
}  // namespace sherd
