// The functions of statics that exist for several levels of processors, as levels_test.cpp has it for others;
// and a load's bits, which are the same alone and beside others.
#include <gtest/gtest.h>

#include <numeric>

#include "levels/built_levels.h"
#include "support/elastic_loads.h"

namespace sherd {
namespace {

using test::Built, test::isHere, test::Numbers, test::Record, test::StaticsLevel;
constexpr Numbers::Kind kKinds[] = {Numbers::Kind::Ordinary, Numbers::Kind::AllSizes, Numbers::Kind::Nasty};

StaticsLevel opened(const char* file) {
  const auto level = test::functionOf<decltype(&sherdStaticsLevel)>(file, "sherdStaticsLevel");
  return level == nullptr ? StaticsLevel{} : level();
}

/// Only what others call.
StaticsLevel theProgramsOwn() {
  StaticsLevel own{};
  own.solve = &solveSupernodal;
  own.respond = [](const ElementResponse& response, const ElementResponse::Block& block) {
    response.add(block);
  };
  return own;
}

/// Load `w` of a block.
std::vector<double> lane(const std::vector<double>& block, std::size_t w) {
  std::vector<double> one(block.size() / kSolveWidth);
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = block[i * kSolveWidth + w];
  return one;
}

/// to_r −= Σ_c M_rc from_c, c ascending, as it stands here: nothing is fused or put into another order.
struct Plain {
  const double* m;
  std::size_t rows, columns, rowStride, columnStride;

  std::vector<double> subtracted(const std::vector<double>& from, std::vector<double> to) const {
    const std::size_t width = to.size() / rows;
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t w = 0; w < width; ++w) {
        volatile double sum = to[r * width + w];
        for (std::size_t c = 0; c < columns; ++c) {
          const volatile double product = m[r * rowStride + c * columnStride] * from[c * width + w];
          sum = sum - product;
        }
        to[r * width + w] = sum;
      }
    return to;
  }
};

/// One block of L with all forms of both products, and plainly.
void addProducts(const StaticsLevel& level, Numbers& numbers, std::size_t rows, std::size_t columns,
                 Record& built, Record& plain) {
  const std::size_t stride = rows + 3;  // rows above that do not belong to it
  const std::vector<double> l = numbers.next(stride * columns);
  const Plain down{l.data(), rows, columns, 1, stride}, up{l.data(), columns, rows, stride, 1};
  const auto compare = [&](const Plain& product, StaticsLevel::Subtract subtract, std::size_t width) {
    const std::vector<double> from = numbers.next(product.columns * width);
    std::vector<double> to = numbers.next(product.rows * width);
    if (product.rows > 0) plain.add(product.subtracted(from, to));
    subtract(l.data(), stride, columns, rows, from.data(), to.data());
    built.add(to);
  };
  compare(down, level.down, 1);
  compare(down, level.downWide, kSolveWidth);
  compare(down, level.downWidest, kSolveWidth);
  compare(up, level.up, 1);
  compare(up, level.upWide, kSolveWidth);
  compare(up, level.upWidest, kSolveWidth);
}

/// A factor of supernodes with as many columns each; below them up to `below` rows of later ones.
struct Factor {
  Factor(const std::vector<std::size_t>& sizes, std::size_t below, Numbers& numbers) {
    const std::size_t all = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
    for (const std::size_t columns : sizes) {
      const std::size_t first = static_cast<std::size_t>(column.back()), next = first + columns;
      const std::size_t step = below == 0 ? all : std::max<std::size_t>(1, (all - next) / below);
      for (std::size_t r = first; r < next; ++r) row.push_back(static_cast<int>(r));
      for (std::size_t r = next, n = 0; r < all && n < below; r += step, ++n)
        row.push_back(static_cast<int>(r));
      const std::size_t rows = row.size() - static_cast<std::size_t>(rowBegin.back());
      for (std::size_t i = 0; i < rows * columns; ++i) value.push_back(numbers.next());
      column.push_back(static_cast<int>(next));
      rowBegin.push_back(static_cast<int>(row.size()));
      valueBegin.push_back(static_cast<int>(value.size()));
    }
  }
  SupernodalFactor view() const {
    return {column.size() - 1, column.data(), rowBegin.data(), valueBegin.data(), row.data(), value.data()};
  }
  std::size_t size() const { return static_cast<std::size_t>(column.back()); }

  std::vector<int> column{0}, rowBegin{0}, valueBegin{0}, row;
  std::vector<double> value;
};

/// Factors from nothing at all over single columns to several panels, with all kinds of numbers.
std::vector<Factor> factors() {
  std::vector<Factor> all;
  for (const Numbers::Kind kind : kKinds) {
    Numbers numbers(kind, 17);
    for (const std::size_t below : {0u, 1u, 5u, 40u})
      for (const auto& sizes : std::vector<std::vector<std::size_t>>{
               {}, {1}, {1, 1}, {3, 3}, {1, 8, 9, 2, 31}, {7, 32, 33, 1, 64, 15}, {16, 70, 5, 5}})
        all.emplace_back(sizes, below, numbers);
  }
  return all;
}

Record solutionsOf(const StaticsLevel& level) {
  Record record;
  Numbers numbers(Numbers::Kind::Ordinary, 19);
  for (const Factor& factor : factors())
    for (const std::size_t width : {std::size_t{1}, kSolveWidth}) {
      std::vector<double> x = numbers.next(width * factor.size());
      level.solve(factor.view(), x.data(), width);
      record.add(x);
    }
  return record;
}

/// Bodies of one order and Poisson's ratio: none, one flat element, one that is good, many.
struct Body {
  Body(TetMesh tets, ElementOrder order, double poisson)
      : mesh(std::make_shared<TetMesh>(std::move(tets))),
        elements(mesh, order),
        rules(order == ElementOrder::Linear
                  ? ElementRules(elements, mesh->insideFraction, {})
                  : ElementRules(elements, std::vector<ElementRule>(mesh->tets.size(), wholeRule()))),
        lame(poisson) {
    for (std::size_t t = 0; t < mesh->tets.size(); ++t) volume.push_back(tetVolume(*mesh, t));
  }
  ElementResponse response() const {
    return {elements, rules, mesh->nodes, volume, VolumetricSplit(lame), lame.mu};
  }

  std::shared_ptr<const TetMesh> mesh;
  Elements elements;
  ElementRules rules;
  Lame lame;
  std::vector<double> volume;
};

template <class Do>
void forEachBody(Do&& once) {
  const auto one = [](double height) {
    return families::withOwnSurface({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3(0.2, 0.3, height)},
                                    {{0, 1, 2, 3}});
  };
  for (const ElementOrder order : {ElementOrder::Linear, ElementOrder::Quadratic})
    for (const double poisson : {0.0, 0.2, 0.4999}) {
      once(Body(TetMesh(), order, poisson));
      once(Body(one(0), order, poisson));
      once(Body(one(1e-5), order, poisson));
      once(Body(one(0.7), order, poisson));
      once(Body(families::jittered(3, Vec3(0.3, 0.2, 0.7)), order, poisson));
    }
}

struct Response {
  std::vector<double> force, energy;
};

Response responseOf(const StaticsLevel& level, const Body& body, const std::vector<double>& displacement,
                    const std::vector<double>& dilatation, std::size_t width) {
  Response out{std::vector<double>(displacement.size(), 0.25),
               std::vector<double>(width * body.mesh->tets.size())};
  level.respond(body.response(),
                {width, displacement.data(), dilatation.empty() ? nullptr : dilatation.data(),
                 out.force.data(), out.energy.data()});
  return out;
}

/// What each body does under any displacements, as a block and one load after the other.
void addResponses(const StaticsLevel& level, Record& wide, Record& alone) {
  for (const Numbers::Kind kind : kKinds) {
    Numbers numbers(kind, 23);
    forEachBody([&](const Body& body) {
      for (const bool averaged : {false, true}) {
        if (averaged && body.elements.order() != ElementOrder::Linear) continue;
        const auto u = numbers.next(3 * kSolveWidth * body.elements.nodeCount());
        const auto theta = numbers.next(averaged ? kSolveWidth * body.mesh->nodes.size() : 0);
        const Response block = responseOf(level, body, u, theta, kSolveWidth);
        for (std::size_t w = 0; w < kSolveWidth; ++w) {
          wide.add(lane(block.force, w)), wide.add(lane(block.energy, w));
          const Response one = responseOf(level, body, lane(u, w), lane(theta, w), 1);
          alone.add(one.force), alone.add(one.energy);
        }
      }
    });
  }
}

Record responsesOf(const StaticsLevel& level) {
  Record wide, alone;
  addResponses(level, wide, alone);
  return wide;
}

class StaticsLevels : public testing::TestWithParam<Built> {
 protected:
  void SetUp() override {
    if (!isHere(GetParam().name)) GTEST_SKIP() << "this processor has no " << GetParam().name;
    level_ = opened(GetParam().file);
    ASSERT_NE(level_.respond, nullptr);
  }
  StaticsLevel level_{};
};

TEST_P(StaticsLevels, SubtractInTheOrderThatIsDocumented) {
  Record built, plain;
  for (const Numbers::Kind kind : kKinds) {
    Numbers numbers(kind, 13);
    for (std::size_t rows = 0; rows <= 19; ++rows)
      for (const std::size_t columns : {0u, 1u, 2u, 7u, 8u, 9u, 17u, 32u})
        addProducts(level_, numbers, rows, columns, built, plain);
    for (const std::size_t rows : {32u, 61u, 200u}) addProducts(level_, numbers, rows, 32, built, plain);
  }
  EXPECT_GT(built.size(), 100000u);
  EXPECT_EQ(built.differing(plain), 0u);
}

TEST_P(StaticsLevels, SolveWithTheBitsThatTheProgramHas) {
  const Record own = solutionsOf(theProgramsOwn()), built = solutionsOf(level_);
  EXPECT_GT(own.size(), 50000u);
  EXPECT_EQ(built.differing(own), 0u);
}

TEST_P(StaticsLevels, SolveForOneLoadAsForMany) {
  Record wide, alone;
  Numbers numbers(Numbers::Kind::AllSizes, 29);
  for (const Factor& factor : factors()) {
    std::vector<double> x = numbers.next(kSolveWidth * factor.size());
    const std::vector<double> right = x;
    level_.solve(factor.view(), x.data(), kSolveWidth);
    for (std::size_t w = 0; w < kSolveWidth; ++w) {
      std::vector<double> one = lane(right, w);
      level_.solve(factor.view(), one.data(), 1);
      wide.add(lane(x, w)), alone.add(one);
    }
  }
  EXPECT_EQ(wide.differing(alone), 0u);
}

TEST_P(StaticsLevels, RespondWithTheBitsThatTheProgramHas) {
  const Record own = responsesOf(theProgramsOwn()), built = responsesOf(level_);
  EXPECT_GT(own.size(), 100000u);
  EXPECT_EQ(built.differing(own), 0u);
}

TEST_P(StaticsLevels, RespondToOneLoadAsToMany) {
  Record wide, alone;
  addResponses(level_, wide, alone);
  EXPECT_EQ(wide.differing(alone), 0u);
}

INSTANTIATE_TEST_SUITE_P(All, StaticsLevels, test::allLevels(), test::levelName);

/// Each comparison would see fused multiply-adds.
TEST(StaticsLevelsControl, FusedSumsAreSeen) {
  if (!isHere("x86_64_v3")) GTEST_SKIP() << "this processor has no x86_64_v3";
  const StaticsLevel fused = opened(LEVEL_FUSED);
  ASSERT_NE(fused.respond, nullptr);
  const StaticsLevel own = theProgramsOwn();
  const Record solutions = solutionsOf(own), responses = responsesOf(own);
  EXPECT_GT(solutionsOf(fused).differing(solutions), solutions.size() / 100);
  EXPECT_GT(responsesOf(fused).differing(responses), responses.size() / 100);
  Record built, plain;
  Numbers numbers(Numbers::Kind::Ordinary, 31);
  addProducts(fused, numbers, 21, 13, built, plain);
  EXPECT_GT(built.differing(plain), built.size() / 10);
}

}  // namespace
}  // namespace sherd
