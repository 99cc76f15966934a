#include <cmath>

#include "graph/json.h"
#include "graph/node_type.h"
#include "train_degree/train_degree.h"

namespace sherd {
namespace {

/// The node's parameters, flat as NodeBuilder wants them.
struct Params {
  TrainDegreeParams defaults;
  std::vector<double> heights, ballSpeeds;
  std::vector<BallHit> ballHits;
  int balls = defaults.balls;
  double ballRadius = defaults.drop.ballRadius, ballDensity = defaults.drop.ballDensity;
  bool standing = defaults.drop.standing;
  int orientations = defaults.orientations, repeats = defaults.repeats, maxDegree = defaults.maxDegree;
  double gamma = defaults.gamma, alpha = defaults.alpha;
  std::int64_t seed = defaults.seed;
  DegreeMethod method = defaults.learn.method;
  double tolerance = defaults.learn.tolerance, trainingError = defaults.learn.trainingError;
  double density = defaults.drop.body.density, young = defaults.drop.body.youngModulus,
         poisson = defaults.drop.body.poissonRatio;
  double gravity = defaults.drop.gravity, restitution = defaults.drop.restitution,
         friction = defaults.drop.friction;
  double obstacleYoung = defaults.drop.obstacleYoung, obstaclePoisson = defaults.drop.obstaclePoisson;
  double contactDuration = defaults.drop.contactDuration, contactRadius = defaults.drop.contactRadius;
  ElementOrder elements = defaults.drop.elements;
  bool refine = defaults.drop.refine;

  TrainDegreeParams forStep() const {
    TrainDegreeParams p;
    p.heights = heights;
    p.ballHits = ballHits;
    p.balls = balls;
    p.ballSpeeds = ballSpeeds;
    p.drop.ballRadius = ballRadius;
    p.drop.ballDensity = ballDensity;
    p.drop.standing = standing;
    p.orientations = orientations;
    p.repeats = repeats;
    p.maxDegree = maxDegree;
    p.gamma = gamma;
    p.alpha = alpha;
    p.seed = seed;
    p.learn = {method, tolerance, trainingError};
    p.drop.body = {density, young, poisson};
    p.drop.gravity = gravity;
    p.drop.restitution = restitution;
    p.drop.friction = friction;
    p.drop.obstacleYoung = obstacleYoung;
    p.drop.obstaclePoisson = obstaclePoisson;
    p.drop.contactDuration = contactDuration;
    p.drop.contactRadius = contactRadius;
    p.drop.elements = elements;
    p.drop.refine = refine;
    return p;
  }
};

using Builder = NodeBuilder<Params>;

/// A list of numbers above 0 in the parameter `name`, each of them an `item`.
Result<std::vector<double>> readAmounts(const std::string& json, const char* name, const char* item,
                                        const char* remedy) {
  Diagnostics diagnostics;
  const auto list = parseJson(json, std::make_shared<const Source>(), diagnostics);
  if (!list || list->kind != JsonValue::Kind::Array)
    return failure(std::string(name) + " would have to be a list of numbers", remedy, name);
  std::vector<double> amounts;
  for (const JsonValue& value : list->items) {
    if (!value.isNumber() || !std::isfinite(value.number) || !(value.number > 0))
      return failure(std::string(item) + ' ' + std::to_string(amounts.size() + 1) + " is " + describe(value) +
                         ", which is no number above 0",
                     remedy, name);
    amounts.push_back(value.number);
  }
  return amounts;
}

Result<std::vector<double>> readHeights(const std::string& json) {
  return readAmounts(json, "heights", "height", "write \"heights\": [0.5, 1, 2], in metres");
}

Result<std::vector<double>> readSpeeds(const std::string& json) {
  return readAmounts(json, "ball_speeds", "speed", "write \"ball_speeds\": [5, 10, 20], in m/s");
}

bool readVector(const JsonValue* value, Vec3& out) {
  if (value == nullptr || value->kind != JsonValue::Kind::Array || value->items.size() != 3) return false;
  for (int k = 0; k < 3; ++k) {
    const JsonValue& number = value->items[static_cast<std::size_t>(k)];
    if (!number.isNumber() || !std::isfinite(number.number)) return false;
    out[k] = number.number;
  }
  return true;
}

Result<std::vector<BallHit>> readBallHits(const std::string& json) {
  const char* name = "ball_hits";
  const char* remedy =
      "write \"ball_hits\": [{ \"target\": [0.5, 0.5, 0.5], \"direction\": [1, 0, 0] }], as Simulate's "
      "ball_target and ball_direction";
  Diagnostics diagnostics;
  const auto list = parseJson(json, std::make_shared<const Source>(), diagnostics);
  if (!list || list->kind != JsonValue::Kind::Array)
    return failure("ball_hits would have to be a list", remedy, name);
  std::vector<BallHit> hits;
  for (const JsonValue& value : list->items) {
    const std::string hit = "hit " + std::to_string(hits.size() + 1);
    BallHit& made = hits.emplace_back();
    for (const JsonMember& member : value.members)
      if (member.key != "target" && member.key != "direction")
        return failure(hit + " has a \"" + member.key + "\", which means nothing", remedy, name);
    if (!readVector(value.find("target"), made.target))
      return failure(hit + " has no target of three numbers", remedy, name);
    if (!readVector(value.find("direction"), made.direction) || made.direction.isZero(0))
      return failure(hit + " has no direction of three numbers that are not all 0", remedy, name);
  }
  return hits;
}

void addExamples(Builder& node) {
  node.number(
      "gamma", &Params::gamma,
      {.unit = "J·m²", .min = 0, .openMin = true, .help = "threshold γ, as PredictDegree is to have it"});
  node.number("alpha", &Params::alpha,
              {.unit = "", .min = 0, .max = 4, .help = "exponent α, as Weights is to have it"});
  node.list(
      "heights", &Params::heights, &readHeights,
      "heights in m that the body is dropped from; none: 0.5, 1, 1.5, 2, 2.5, 3. More cost next to nothing");
  node.integer("orientations", &Params::orientations,
               {.unit = "",
                .min = 0,
                .max = 1e5,
                .help = "how many ways the body is turned for drops, evenly spread; the model is the better "
                        "for more. 0: no drops"});
  node.integer(
      "repeats", &Params::repeats,
      {.unit = "", .min = 1, .max = 100, .help = "searches of each example, with one seed after the other"});
  node.integer("seed", &Params::seed,
               {.unit = "", .help = "another seed gives other orientations, other hits and other searches"});
  node.integer(
      "max_degree", &Params::maxDegree,
      {.unit = "", .min = 1, .max = 1e6, .help = "what breaks into more pieces than this is left out"});
}

void addBalls(Builder& node) {
  node.integer("balls", &Params::balls,
               {.unit = "",
                .min = 0,
                .max = 1e5,
                .help = "at how many places balls are thrown as well, evenly spread over the surface"});
  node.list("ball_hits", &Params::ballHits, &readBallHits,
            "further hits by balls, each {\"target\": [x, y, z], \"direction\": [x, y, z]} as Simulate's "
            "ball_target and ball_direction");
  node.list("ball_speeds", &Params::ballSpeeds, &readSpeeds,
            "speeds in m/s that balls are thrown with; none: 2.5, 5, 7.5, 10, 12.5, 15. More cost next to "
            "nothing");
  node.number("ball_radius", &Params::ballRadius,
              {.unit = "m", .min = 0, .openMin = true, .help = "of the balls, as Simulate is to have it"});
  node.number("ball_density", &Params::ballDensity,
              {.unit = "kg/m³", .min = 0, .openMin = true, .help = "of the balls; steel is 7800"});
  node.boolean("standing", &Params::standing,
               "for balls: the body stands on the floor, which holds against the hit; otherwise it floats");
}

void addLearning(Builder& node) {
  node.choice(
      "method", &Params::method,
      {{"best", DegreeMethod::Process}, {"paper", DegreeMethod::Network}, {"exact", DegreeMethod::Exact}},
      "best: a quick count of cells in place of the search, and a Gaussian process for how far that is off, "
      "by "
      "how much energy there is and how it is spread; paper: a network of radial basis functions on the "
      "principal components; exact: one "
      "that goes through all examples, for comparison");
  node.number("pca_tolerance", &Params::tolerance,
              {.unit = "",
               .min = 0,
               .max = 1,
               .openMax = true,
               .help = "what principal components may leave of the examples, as a share of the norm of all "
                       "deviations from their mean"});
  node.number("training_error", &Params::trainingError,
              {.unit = "",
               .min = 0,
               .help = "paper: centres are added until the error on the examples is this share of the mean "
                       "degree"});
}

void addDrop(Builder& node) {
  node.number("density", &Params::density,
              {.unit = "kg/m³", .min = 0, .openMin = true, .help = "of the body, as Simulate is to have it"});
  node.number(
      "young", &Params::young,
      {.unit = "Pa", .min = 0, .openMin = true, .help = "the body's Young's modulus, as in Simulate"});
  node.number("poisson", &Params::poisson,
              {.unit = "",
               .min = -1,
               .max = 0.5,
               .openMin = true,
               .openMax = true,
               .help = "the body's Poisson's ratio, as in Simulate"});
  node.number("gravity", &Params::gravity,
              {.unit = "m/s²", .min = 0, .openMin = true, .help = "downwards (−y); plays no part for balls"});
  node.number(
      "obstacle_young", &Params::obstacleYoung,
      {.unit = "Pa", .min = 0, .openMin = true, .help = "Young's modulus of the floor and the balls"});
  node.number("obstacle_poisson", &Params::obstaclePoisson,
              {.unit = "",
               .min = -1,
               .max = 0.5,
               .openMin = true,
               .openMax = true,
               .help = "Poisson's ratio of the floor and the balls"});
  node.number("restitution", &Params::restitution,
              {.unit = "", .min = 0, .max = 1, .help = "share of the speed that bounces back"});
  node.number("friction", &Params::friction, {.unit = "", .min = 0, .help = "Coulomb's coefficient"});
  node.number("contact_duration", &Params::contactDuration,
              {.unit = "s",
               .min = 0,
               .help = "that the impulse is spread over; 0: Hertz's, from materials and speed"});
  node.number(
      "contact_radius", &Params::contactRadius,
      {.unit = "m",
       .min = 0,
       .help = "of the patch that the force acts on; 0: Hertz's, but at least 3 % of the body's size"});
  node.choice("elements", &Params::elements,
              {{"linear", ElementOrder::Linear}, {"quadratic", ElementOrder::Quadratic}},
              "as in Simulate: quadratic ones cost some fifteen times as much on the same tetrahedra");
  node.boolean(
      "refine", &Params::refine,
      "as in Simulate, for quadratic elements: a third of a second an orientation at 5,000 tetrahedra, where "
      "it is some milliseconds without");
}

}  // namespace

NodeType trainDegreeNode() {
  Builder node(
      "TrainDegree", 1,
      "Drops the body in many ways, or throws balls at it, searches into how many pieces it breaks "
      "each time, and learns to foretell that. What was computed is kept: more examples cost what is "
      "new, and a training that was ended goes on.");
  node.implementation(4);
  node.input<TetMesh>("body", "the body that is dropped or hit");
  node.input<Embedding>("embedding", "the distances to measure with, from Embed");
  node.optionalInput<ScalarGrid>("beta", "painted fragility β, as Weights is to have it");
  node.optionalGatheredInput<Impact>(
      "impacts", "further examples: impacts of this body in an earlier shot, from Simulate");
  addExamples(node);
  addBalls(node);
  addLearning(node);
  addDrop(node);
  node.uninterruptible("CHOLMOD's factorization", 150);  // of 20,000 linear tetrahedra; 8 s of quadratic ones
  node.output<DegreeModel>("model", "what was learned, for PredictDegree");
  node.output<std::string>("table",
                           "the examples as CSV: a line for each, with its searches and the model's word");
  node.output<double>("error", "mean absolute error on examples left out, as a share of the mean degree");
  return node.run([](const Params& params, NodeIo& io) -> Result<void> {
    TrainDegreeParams wanted = params.forStep();
    for (const auto& impact : io.all<Impact>("impacts")) wanted.impacts.push_back(*impact.value);
    SHERD_ASSIGN(TrainDegreeOutput out,
                 trainDegree(io.in<TetMesh>("body"), io.in<Embedding>("embedding"),
                             io.in<ScalarGrid>("beta").get(), wanted, io.exec(), io.memo()));
    const DegreeErrors& errors = out.model.errors;
    io.out("error", errors.meanDegree > 0 ? errors.meanAbsolute / errors.meanDegree : 0.0);
    io.out("model", std::move(out.model));
    io.out("table", std::move(out.table));
    return {};
  });
}

}  // namespace sherd
