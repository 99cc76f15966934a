#include "graph/node_type.h"
#include "simulate/simulate.h"

namespace sherd {
namespace {

/// The node's parameters, flat as NodeBuilder wants them.
struct Params {
  RigidScene scene = RigidScene::Floor;
  SimulateParams defaults;
  double density = defaults.body.density, young = defaults.body.youngModulus,
         poisson = defaults.body.poissonRatio;
  double dropHeight = defaults.dropHeight, gravity = defaults.gravity;
  Vec3 orientation = defaults.orientation, velocity = defaults.velocity,
       angularVelocity = defaults.angularVelocity;
  double ballRadius = defaults.ballRadius, ballDensity = defaults.ballDensity, ballSpeed = defaults.ballSpeed;
  Vec3 ballDirection = defaults.ballDirection, ballTarget = defaults.ballTarget;
  bool standing = defaults.standing;
  double restitution = defaults.restitution, friction = defaults.friction;
  double obstacleYoung = defaults.obstacleYoung, obstaclePoisson = defaults.obstaclePoisson;
  double contactDuration = defaults.contactDuration, contactRadius = defaults.contactRadius;
  double timeStep = defaults.timeStep, maxTime = defaults.maxTime, threshold = defaults.threshold;
  ElementOrder elements = defaults.elements;
  bool refine = defaults.refine;

  SimulateParams forStep() const {
    SimulateParams p;
    p.scene = scene;
    p.body = {density, young, poisson};
    p.orientation = orientation;
    p.velocity = velocity;
    p.angularVelocity = angularVelocity;
    p.gravity = gravity;
    p.dropHeight = dropHeight;
    p.ballRadius = ballRadius;
    p.ballDensity = ballDensity;
    p.ballSpeed = ballSpeed;
    p.ballDirection = ballDirection;
    p.ballTarget = ballTarget;
    p.standing = standing;
    p.restitution = restitution;
    p.friction = friction;
    p.obstacleYoung = obstacleYoung;
    p.obstaclePoisson = obstaclePoisson;
    p.contactDuration = contactDuration;
    p.contactRadius = contactRadius;
    p.timeStep = timeStep;
    p.maxTime = maxTime;
    p.threshold = threshold;
    p.elements = elements;
    p.refine = refine;
    return p;
  }
};

using Builder = NodeBuilder<Params>;

void addScene(Builder& node) {
  node.choice("scene", &Params::scene, {{"floor", RigidScene::Floor}, {"ball", RigidScene::Ball}},
              "floor: the body is dropped on the plane y = 0; ball: a ball is thrown at the body");
  node.number("drop_height", &Params::dropHeight,
              {.unit = "m", .min = 0, .help = "from the floor to the body's lowest point at the release"});
  node.vector3(
      "orientation", &Params::orientation,
      {.unit = "degrees", .help = "turns the body about its centre of mass: about x, then y, then z"});
  node.vector3("velocity", &Params::velocity, {.unit = "m/s", .help = "of the body at the release"});
  node.vector3(
      "angular_velocity", &Params::angularVelocity,
      {.unit = "rad/s", .min = -1e4, .max = 1e4, .help = "of the body at the release, about world axes"});
  node.number("gravity", &Params::gravity,
              {.unit = "m/s²", .min = 0, .help = "downwards (−y); plays no part in the ball scene"});
}

void addBall(Builder& node) {
  node.number("ball_radius", &Params::ballRadius,
              {.unit = "m", .min = 0, .openMin = true, .help = "of the ball"});
  node.number("ball_density", &Params::ballDensity,
              {.unit = "kg/m³", .min = 0, .openMin = true, .help = "of the ball; steel is 7800"});
  node.number("ball_speed", &Params::ballSpeed,
              {.unit = "m/s", .min = 0, .openMin = true, .help = "of the ball, along a straight line"});
  node.vector3("ball_direction", &Params::ballDirection,
               {.unit = "", .help = "where the ball flies; any length"});
  node.vector3("ball_target", &Params::ballTarget,
               {.unit = "",
                .help = "where its path leads, in the bounding box of the turned body: from 0 0 0, its "
                        "low corner, to 1 1 1, its high corner"});
  node.boolean("standing", &Params::standing,
               "ball scene: the body stands on the floor, which holds against the hit; otherwise it floats");
}

void addMaterial(Builder& node) {
  node.number("density", &Params::density,
              {.unit = "kg/m³", .min = 0, .openMin = true, .help = "of the body"});
  node.number("young", &Params::young,
              {.unit = "Pa", .min = 0, .openMin = true, .help = "the body's Young's modulus"});
  node.number("poisson", &Params::poisson,
              {.unit = "",
               .min = -1,
               .max = 0.5,
               .openMin = true,
               .openMax = true,
               .help = "the body's Poisson's ratio"});
  node.number("obstacle_young", &Params::obstacleYoung,
              {.unit = "Pa", .min = 0, .openMin = true, .help = "Young's modulus of the floor or the ball"});
  node.number("obstacle_poisson", &Params::obstaclePoisson,
              {.unit = "",
               .min = -1,
               .max = 0.5,
               .openMin = true,
               .openMax = true,
               .help = "Poisson's ratio of the floor or the ball"});
  node.number("restitution", &Params::restitution,
              {.unit = "", .min = 0, .max = 1, .help = "share of the speed that bounces back"});
  node.number("friction", &Params::friction, {.unit = "", .min = 0, .help = "Coulomb's coefficient"});
}

void addElements(Builder& node) {
  node.choice(
      "elements", &Params::elements,
      {{"linear", ElementOrder::Linear}, {"quadratic", ElementOrder::Quadratic}},
      "linear: a node at every corner of a tetrahedron; quadratic: one more in the middle of every edge, for "
      "some fifteen times the time on the same tetrahedra, and bodies that bend are no longer too stiff");
  node.boolean(
      "refine", &Params::refine,
      "quadratic elements: computes as if tetrahedra were smaller where the hit presses and where much "
      "of the energy is, for energies within some 5 % at 5,000 tetrahedra; linear ones stay as they are");
}

void addContact(Builder& node) {
  node.number("contact_duration", &Params::contactDuration,
              {.unit = "s",
               .min = 0,
               .help = "that the impulse is spread over; 0: Hertz's, from materials and speed"});
  node.number(
      "contact_radius", &Params::contactRadius,
      {.unit = "m",
       .min = 0,
       .help = "of the patch that the force acts on; 0: Hertz's, but at least 3 % of the body's size"});
  node.number("time_step", &Params::timeStep,
              {.unit = "s", .min = 1e-6, .max = 1, .help = "longest step of the flight's rotation"});
  node.number("max_time", &Params::maxTime,
              {.unit = "s",
               .min = 0,
               .max = kLongestWait,
               .openMin = true,
               .help = "how long to wait for an impact"});
  node.number("threshold", &Params::threshold,
              {.unit = "N·s", .min = 0, .help = "a hit with less impulse than this deforms nothing"});
}

}  // namespace

NodeType simulateNode() {
  Builder node("Simulate", 1,
               "Moves the body until it is first hit, and gives the strain energy of that hit.");
  node.implementation(3);
  node.input<TetMesh>("body", "the body that is dropped or hit");
  addScene(node);
  addBall(node);
  addMaterial(node);
  addContact(node);
  addElements(node);
  node.uninterruptible("CHOLMOD's factorization", 150);  // of 20,000 linear tetrahedra; 4 s of quadratic ones
  node.output<EnergyField>("energy", "strain energy per tetrahedron and node");
  node.output<Impact>("impact", "contacts and motion at the first impact");
  node.output<double>("work", "total strain energy, J");
  return node.run([](const Params& params, NodeIo& io) -> Result<void> {
    SHERD_ASSIGN(SimulateOutput out, simulate(io.in<TetMesh>("body"), params.forStep(), io.exec()));
    io.out("work", totalEnergy(out.energy));
    io.out("energy", std::move(out.energy));
    io.out("impact", std::move(out.impact));
    return {};
  });
}

}  // namespace sherd
