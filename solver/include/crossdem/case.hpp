#pragma once
// The case: what is simulated, as plain structs in SI units. The keys of a case file are described once, in
// src/case_schema.hpp, by which files are read and resolved cases are written.

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace crossdem {

/// Table 2 of the paper, and two options beyond it; one set for particle-particle and one for particle-wall contacts.
struct ContactParameters {
  double normal_stiffness = 0.0;  // k_n [N/m]
  double shear_stiffness = 0.0;   // k_s [N/m]
  double normal_damping = 0.0;    // eta_n [N s/m]
  double shear_damping = 0.0;     // eta_s [N s/m]
  double friction = 0.0;          // mu [-]
  double tensile_strength = 0.0;  // T [N], of the joint of two particles; 0: none, as in the paper
  double rolling_friction = 0.0;  // mu_r [-]; 0: no resistance to rolling, as in the paper

  /// [m] Over which a joint stretches before it breaks.
  [[nodiscard]] double joint_stretch() const { return tensile_strength / normal_stiffness; }
};

/// Left wall at x = 0, right wall at x = width, floor at y = 0, no lid.
struct Container {
  double width = 0.0;      // [m]
  double height = 0.0;     // [m]
  double thickness = 0.0;  // [m], of every disc too
};

struct ParticleMix {
  int count = 0;
  std::vector<double> diameters;      // [m]
  std::vector<double> number_shares;  // of each diameter, sum 1
  double density = 0.0;               // [kg/m^3]
};

/// A particle placed by hand, instead of a bed that settles.
struct PlacedParticle {
  double x = 0.0;                 // [m], of the centre
  double y = 0.0;                 // [m]
  double radius = 0.0;            // [m]
  double velocity_x = 0.0;        // [m/s]
  double velocity_y = 0.0;        // [m/s]
  double angular_velocity = 0.0;  // [rad/s], counter-clockwise
};

struct BarGeometry {
  double width = 0.0;     // [m]
  double length = 0.0;    // [m]
  double centre_x = 0.0;  // [m]
  double speed = 0.0;     // [m/s], downwards
  double tip = 0.0;       // [m], y of the bottom face at the start; 0: it touches the topmost particle under it
};

/// t = 0 is when the bar starts or, without a bar, when the rest is over.
struct TimeControl {
  double step = 0.0;             // [s]
  double rest = 0.0;             // [s] before t = 0
  double penetration = 0.0;      // [s] from t = 0 on
  double sample_interval = 0.0;  // [s] between rows of resistance
  double frame_interval = 0.0;   // [s] between frames of motion
  bool allow_above_eq32 = false;

  [[nodiscard]] long steps_in(double interval) const;  // of an interval [s] that is a whole number of them
};

struct EngineSettings {
  double step = 0.0;  // [s]
};

/// How the settled bed is made: a jittered lattice of particles with small random velocities falls and comes to rest.
struct PackingRecipe {
  double lattice_spacing = 0.0;   // [m]
  double jitter = 0.0;            // [m], uniform in +-
  double velocity = 0.0;          // [m/s], uniform in +-
  double wall_friction = 0.0;     // [-], of the container while settling
  double step = 0.0;              // [s]
  double settling = 0.0;          // [s], at least
  double longest_settling = 0.0;  // [s], an error beyond
  double kinetic_energy = 0.0;    // [J], settled below
};

enum class UpdateOrder { forces_then_moves, in_turn };
enum class FirstContactNormal { spring_and_dashpot, spring_only };
enum class FirstContactShear { clamped_share, raw_share, whole_step };
enum class LostContact { forget, keep_zero, keep_negative };
enum class Attraction { allowed, clipped };
enum class NormalSpring { incremental, overlap };
enum class DashpotVelocity { averaged_displacement, true_velocity };
enum class InitialDisplacement { velocity, zero };
enum class BarCorner { nearest_point, faces_only };
enum class SlipCap { spring, total };
enum class TorqueArm { radius, contact_point };
enum class Integration { averaged_displacement, leap_frog, velocity_verlet };
enum class Inertia { disc, sphere };

/// Where the paper's text leaves a choice, and where established codes do otherwise: the reading taken. The initial
/// values are the default readings.
struct Readings {
  UpdateOrder update_order = UpdateOrder::forces_then_moves;
  FirstContactNormal first_contact_normal = FirstContactNormal::spring_and_dashpot;
  FirstContactShear first_contact_shear = FirstContactShear::clamped_share;
  LostContact lost_contact = LostContact::forget;
  Attraction attraction = Attraction::allowed;
  NormalSpring normal_spring = NormalSpring::incremental;
  DashpotVelocity dashpot_velocity = DashpotVelocity::averaged_displacement;
  InitialDisplacement initial_displacement = InitialDisplacement::velocity;
  BarCorner bar_corner = BarCorner::nearest_point;
  SlipCap slip_cap = SlipCap::spring;
  TorqueArm torque_arm = TorqueArm::radius;
  Integration integrator = Integration::averaged_displacement;
  Inertia inertia = Inertia::disc;

  bool operator==(const Readings&) const = default;
};

struct SchemeChoice {
  std::string name;   // paper; or liggghts, yade, liggghts_averaged, yade_averaged: what these codes do, step by step
  Readings readings;  // of the scheme "paper"; the others have their own
};

/// What a run must pass before it is compared.
struct Gates {
  double rest_kinetic_energy = 0.0;  // [J], upper limit at the end of the rest
  double contacts_share = 0.0;       // [-], largest relative difference of contacts per particle to native
};

/// What the comparison looks at.
struct Marks {
  double layer_height = 0.0;  // [m]
  double cell_size = 0.0;     // [m]
  double near_bar = 0.0;      // [m]
};

enum class MarginKind { relative, absolute, ratio };

/// One endpoint that engines must agree on. Which quantities exist is known to the comparison, not to the solver.
struct Check {
  std::string quantity;
  MarginKind kind = MarginKind::relative;
  double margin = 0.0;        // of the engines' difference, in the sense of `kind`
  double seed_scatter = 0.0;  // standard deviation of one run from seed to seed, in the sense of `kind`
  std::string reason;
};

/// What a case with a known answer says: a closed form or an invariant. Which there are is known to the comparison.
struct Answer {
  std::string quantity;
  MarginKind kind = MarginKind::relative;
  double tolerance = 0.0;  // of the limit of vanishing time steps, in the sense of `kind`
  std::string reason;
};

/// An engine that is known to miss an answer, by how much, and why.
struct ExpectedDifference {
  std::string engine;
  std::string quantity;
  double value = 0.0;      // limit less answer, in the quantity's unit
  double tolerance = 0.0;  // in the quantity's unit
  std::string reason;
};

/// How far an engine may be from the native scheme that does what it does, where that is not to the last bit.
struct TwinLimit {
  std::string engine;
  double limit = 0.0;  // [m], largest difference of a position
  double until = 0.0;  // [s], from t = 0
  std::string reason;
};

struct Case {
  std::string name;
  std::string title;
  double gravity = 0.0;  // [m/s^2], acts in -y
  Container container;
  std::vector<PlacedParticle> placed;  // none: a bed of `particles` is settled
  ParticleMix particles;               // that of `placed`, where there are any
  std::optional<BarGeometry> bar;
  ContactParameters particle_particle;
  ContactParameters particle_wall;
  TimeControl time;
  std::map<std::string, EngineSettings> engines;
  PackingRecipe packing;
  SchemeChoice scheme;
  Gates gates;
  Marks marks;
  std::vector<Check> checks;
  std::vector<Answer> answers;
  std::vector<ExpectedDifference> differences;
  std::vector<TwinLimit> twins;

  /// [kg] of a disc of this radius [m]: rho pi r^2 h.
  [[nodiscard]] double disc_mass(double radius) const;
};

/// Bad input: every fault found, each "key.path: message".
class CaseError : public std::runtime_error {
 public:
  explicit CaseError(std::vector<std::string> faults);
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }

 private:
  std::vector<std::string> faults_;
};

/// Reads a case from JSON, strictly: unknown or missing keys, wrong types, numbers out of range and contradictions are
/// all reported together as a CaseError; text that is not JSON too.
Case read_case(std::string_view json);

/// The resolved case as canonical JSON: defaults filled, SI, keys sorted, no white space. Its SHA-256 names the case.
std::string canonical_json(const Case& resolved);

/// What is legal but needs saying, one sentence each: a time step above the packed-bed limit of its scheme.
std::vector<std::string> warnings(const Case& resolved);

/// Eq. (32): 0.75 sqrt(m/k), the smallest over particle sizes and stiffnesses [s].
double eq32_time_step(const Case& resolved);

/// [s] The linear bound of a packed bed: the explicit shear dashpots acting on the spin of the smallest disc with four
/// contacts have the rate 16 eta_s / m; a scheme is stable while rate x step < `gain`.
double packed_bed_time_step(const Case& resolved, double gain);

inline constexpr double averaged_displacement_gain = 6.0;  // linear analysis of Eqs. (16)-(21) with a pure dashpot
inline constexpr double conventional_gain = 2.0;           // leap-frog and velocity Verlet

}  // namespace crossdem
