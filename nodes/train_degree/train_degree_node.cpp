#include <cmath>

#include "graph/json.h"
#include "graph/node_type.h"
#include "train_degree/train_degree.h"

namespace sherd {
namespace {

/// The node's parameters, flat as NodeBuilder wants them.
struct Params {
  TrainDegreeParams defaults;
  std::vector<double> heights;
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

  TrainDegreeParams forStep() const {
    TrainDegreeParams p;
    p.heights = heights;
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
    return p;
  }
};

using Builder = NodeBuilder<Params>;

Result<std::vector<double>> readHeights(const std::string& json) {
  const char* remedy = "write \"heights\": [0.5, 1, 2], in metres";
  Diagnostics diagnostics;
  const auto list = parseJson(json, std::make_shared<const Source>(), diagnostics);
  if (!list || list->kind != JsonValue::Kind::Array)
    return failure("heights would have to be a list of numbers", remedy, "heights");
  std::vector<double> heights;
  for (const JsonValue& item : list->items) {
    if (!item.isNumber() || !std::isfinite(item.number) || !(item.number > 0))
      return failure("height " + std::to_string(heights.size() + 1) + " is " + describe(item) +
                         ", which is no number above 0",
                     remedy, "heights");
    heights.push_back(item.number);
  }
  return heights;
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
                .min = 1,
                .max = 1e5,
                .help = "how many ways the body is turned, evenly spread; the model is the better for more"});
  node.integer(
      "repeats", &Params::repeats,
      {.unit = "", .min = 1, .max = 100, .help = "searches of each drop, with one seed after the other"});
  node.integer("seed", &Params::seed,
               {.unit = "", .help = "another seed gives other orientations and other searches"});
  node.integer("max_degree", &Params::maxDegree,
               {.unit = "", .min = 1, .max = 1e6, .help = "a drop into more pieces than this is left out"});
}

void addLearning(Builder& node) {
  node.choice(
      "method", &Params::method,
      {{"best", DegreeMethod::Process}, {"paper", DegreeMethod::Network}, {"exact", DegreeMethod::Exact}},
      "best: a Gaussian process of the logarithms of the degree and of how much energy there is and how it "
      "is spread; paper: a network of radial basis functions on the principal components; exact: one "
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
              {.unit = "m/s²", .min = 0, .openMin = true, .help = "downwards (−y)"});
  node.number("obstacle_young", &Params::obstacleYoung,
              {.unit = "Pa", .min = 0, .openMin = true, .help = "Young's modulus of the floor"});
  node.number("obstacle_poisson", &Params::obstaclePoisson,
              {.unit = "",
               .min = -1,
               .max = 0.5,
               .openMin = true,
               .openMax = true,
               .help = "Poisson's ratio of the floor"});
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
}

}  // namespace

NodeType trainDegreeNode() {
  Builder node(
      "TrainDegree", 1,
      "Drops the body in many ways, searches into how many pieces it breaks each time, and learns to "
      "foretell that.");
  node.input<TetMesh>("body", "the body that is dropped");
  node.input<Embedding>("embedding", "the distances to measure with, from Embed");
  node.optionalInput<ScalarGrid>("beta", "painted fragility β, as Weights is to have it");
  addExamples(node);
  addLearning(node);
  addDrop(node);
  node.uninterruptible("CHOLMOD's factorization", 150);  // of 20,000 linear tetrahedra; 8 s of quadratic ones
  node.output<DegreeModel>("model", "what was learned, for PredictDegree");
  node.output<std::string>("table",
                           "the examples as CSV: a line per drop, with its searches and the model's word");
  node.output<double>("error", "mean absolute error on orientations left out, as a share of the mean degree");
  return node.run([](const Params& params, NodeIo& io) -> Result<void> {
    SHERD_ASSIGN(TrainDegreeOutput out,
                 trainDegree(io.in<TetMesh>("body"), io.in<Embedding>("embedding"),
                             io.in<ScalarGrid>("beta").get(), params.forStep(), io.exec()));
    const DegreeErrors& errors = out.model.errors;
    io.out("error", errors.meanDegree > 0 ? errors.meanAbsolute / errors.meanDegree : 0.0);
    io.out("model", std::move(out.model));
    io.out("table", std::move(out.table));
    return {};
  });
}

}  // namespace sherd
