// A physical effect: its card, what it does to the force at its stage, and the derivative of that.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/vec3.h"
#include "estimate/spectral_line.h"
#include "material/body_features.h"

namespace hapsim {

constexpr double kSamePlace = 1e-4;  // contact points nearer than this are one [m]

// In the order in which a press passes through them: the tool's motion, then the force.
enum class Stage { kMotion, kBody, kSupport, kContact, kSensor };

// One parameter of an effect. `identity` is the value at which the effect does nothing.
struct ParameterCard {
  std::string name;  // "E1": effects with terms number them, the card names the first
  std::string unit;  // SI; "1" for a pure number
  std::string meaning;
  double identity = 0;
  double start = 0;
  double lower = 0;
  double upper = 0;
  double scale = 1;                                             // size of a typical change
  bool logarithmic = false;                                     // stepped in its logarithm
  double log_limit = std::numeric_limits<double>::quiet_NaN();  // stepped in log(limit - value)
  bool fixed = false;                                           // a switch: set, never fitted
  bool optional = false;  // a model file without it means its identity
};

// Constant data on an effect; man pages, diagnoses and generic tests derive from it.
struct EffectCard {
  std::string name;  // as in models, flags and files
  Stage stage = Stage::kBody;
  std::string title;  // plain words: "the material relaxes with time"
  std::string equation;
  std::string source;
  std::string assumptions;
  std::vector<ParameterCard> parameters;
  // What rows of a region above 0 may have besides; never there unless a model's file has it.
  std::vector<ParameterCard> of_region = {};
  bool terms = false;              // may be repeated: E1, tau1, E2, tau2, ...
  bool needs_time = false;         // not testable without a t column
  bool needs_session = false;      // not testable if the time begins anew with each press
  bool needs_positions = false;    // not testable with a single contact position
  bool needs_temperature = false;  // not testable unless the column temp varies
  bool needs_sideways = false;     // not testable without tangential displacement
  bool needs_return = false;       // not testable unless a recorded press moves out again
  bool shows_at_starts = false;    // without a way out it shows where presses begin alone: of many
  bool needs_rim = false;          // not testable between plates: acts under a part of the surface
  bool needs_flat = false;         // not testable with a ball
  bool needs_repeats = false;  // not testable unless a place is pressed again, or time has passed
  bool needs_ceiling = false;  // not testable unless readings are exactly the largest of their axis
  bool needs_line = false;     // not testable unless a frequency stands out of what a model leaves
  bool among_presses = false;  // told by comparing presses: of few it is not tested
  bool one_body = false;       // its parameters are of one body's shape or place
  bool one_tool = false;       // its parameters are of one tool
  bool per_press = false;      // a set of parameters a press, solved for exactly in every fit
  bool solved = false;         // finite elements are solved for its parameters (add_feature())
  double form_error = 0;       // share of the force that it changes by which its law may err
  bool local = false;          // may act at few positions only, of which the others tell nothing
  bool like_shape = false;     // a wrong shape of the body looks like it
  bool is_map = false;         // a map over the body, made from what each place asks for
  // A smooth field over the body. Parameters whose names end in 1 are a set a place, learned in
  // every fit from what each place asks for; the others are common to all.
  bool is_field = false;
  // A curve of no law over depth, time or the session: tried where no named effect explains.
  bool learned = false;
  // Fitted only where what it changes about its starts takes something away, to first order: for
  // what is smooth in its parameters and what most recordings have nothing of.
  bool screened = false;
  // The body itself, which every model has and which is neither tried nor removed: its parameters
  // that are Young's modulus (a row a region) and Poisson's ratio.
  std::string modulus, poissons_ratio;
  bool maxwell = false;     // terms of a modulus and a relaxation time: Maxwell elements
  bool moves_body = false;  // says where the body lies
  double most_bend = 0;   // a sensor bends by no more of its range off a straight line; 0: any does
  std::string signature;  // what its absence looks like in the residuals
  std::vector<std::string> confounders;
  std::string separated_by;           // the measurement that tells it from them
  std::vector<std::string> contains;  // effects that this one includes as a special case
  std::vector<std::string>
      kinds;                  // of what is left (LeftOver::kind): what it is, the nearest first
  bool of_recording = false;  // in how a recording was put together: a live loop does without it
  bool looks_ahead = false;  // asks for what comes later in the press: its step takes what has come
  // Where its step (Effect::step) is not what a whole press would have: why, and what it does
  // instead. "": sample by sample it is the same.
  std::string live;
};

// A parameter's value as the model hands it to an effect. `column` is its column in the derivative
// matrix, -1 when it is not free.
struct ParameterValue {
  int region = 0;
  std::string name;
  double value = 0;
  int column = -1;
};
using Values = std::vector<ParameterValue>;

// The body's stiffness against the flat bonded tool at a press, and the material under the tool.
struct ContactStiffness {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();  // [N/m]; the body's force on the tool is -K u
  std::vector<std::pair<int, Eigen::Matrix3d>> by_column;     // derivatives by free parameters
  double modulus = 0;                                         // E [Pa]
  std::vector<std::pair<int, double>> log_modulus_by_column;  // d log E / d parameter
  double nu = 0.3;
  int nu_column = -1;
};

// One press as effects see it, n samples.
struct PressView {
  std::vector<double> t;        // [s] since the press began; empty without time
  std::vector<double> session;  // [s] since the recording began; empty without time
  std::vector<Vec3> u;          // displacement of the tool [m]
  Eigen::MatrixXd du;           // 3 n x parameters, derivative of u; no columns: u is as recorded
  std::vector<char> in_air;     // 1: no contact
  std::vector<double> temperature;  // [degC]; empty without
  Vec3 point = Vec3::Zero();        // of contact, on the undeformed surface [m]
  Vec3 normal = Vec3::UnitZ();      // outward, at the contact
  Vec3 direction = -Vec3::UnitZ();  // unit, of the deepest displacement of the press
  double past_depth = 0;            // deepest |u| of earlier presses here that is not healed [m]
  int number = 1;                   // of the press, from 1, in the order of the recording
  double radius = 0;                // of the tool [m]
  double height = 0;                // of a body between plates [m]; 0: the tool covers a part of it
  double modulus = 0;               // E of region 0 [Pa]
  int modulus_column = -1;
  ContactStiffness contact;
  std::size_t size() const { return u.size(); }
};

// Force on the tool of one press and its derivatives by the free parameters.
struct Signal {
  Eigen::VectorXd f;   // 3 n: fx, fy, fz of sample 0, then of sample 1 ... [N]
  Eigen::MatrixXd df;  // 3 n x parameters; no columns when derivatives are not wanted
};

// The tool's displacements of one press and their derivatives by the free parameters.
struct Motion {
  std::vector<Vec3> u;       // [m]
  Eigen::MatrixXd du;        // 3 n x columns, or no columns while nothing depends on parameters
  Eigen::Index columns = 0;  // of the derivative; 0: not wanted
  void make_du();            // gives du its columns
};

// A feature of the body as an effect asks for it; columns as its values.
struct FeatureSpec {
  BodyFeature feature;
  std::vector<int> column;
};

// What body and support effects say of the material.
struct MaterialSpec {
  double nu = 0.3;
  int nu_column = -1;
  std::vector<double> modulus;  // E [Pa] by region
  std::vector<int> modulus_column;
  std::vector<int> given;       // regions that have a modulus of their own
  std::vector<Vec3> key_point;  // region of a point: that of its nearest key point, in plan view
  std::vector<int> key_region;
  // A contact feels the modulus at its own place alone, as if the whole body had it: that of its
  // key point, or interpolated from those around it.
  bool local = false;
  std::vector<FeatureSpec> features;
  // How the body has moved since it was scanned, about the middle of the contact points.
  Vec3 shift = Vec3::Zero(), rotation = Vec3::Zero();  // [m], rotation vector [rad]
};

// The modulus that one contact position asks for, over the model's.
struct PlaceGain {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
  double gain = 1;
};

// What a data set offers, from which starts are chosen.
struct DataSummary {
  bool has_time = false;
  double sample_step = 0;                  // median time step [s]
  double press_duration = 0;               // median [s]
  double session = 0;                      // [s]
  double modulus = 1e4;                    // E of the model at hand [Pa]
  double peak_force = 1;                   // [N]
  double peak_along = 1, peak_across = 1;  // |fz| and |(fx, fy)| [N]
  double peak_stiffness = 1;               // [N/m]
  double temperature = 20;                 // to count from [degC]
  double depth = 2e-3;                     // deepest displacement [m]
  double tool_radius = 4e-3;               // [m]
  std::size_t presses = 1;
  double ball_radius = 0;       // [m] of a tool that is declared a ball; 0: another
  Vec3 ceiling = Vec3::Zero();  // readings of an axis that are exactly its largest [N]; 0: none
  SpectralLine line;            // of the forces that the model at hand leaves, for who needs one
  std::vector<PlaceGain> places;
  Vec3 low = Vec3::Constant(-10), high = Vec3::Constant(10);  // the body's box [m]
  // The move that brings the contact points onto the scanned surface; zero where they lie on it.
  Vec3 shift = Vec3::Zero(), rotation = Vec3::Zero();  // [m], [rad]
};

// One Maxwell element of a body: its modulus over the elastic one, and its relaxation time [s].
struct MaxwellTerm {
  double share = 0;
  double tau = 1;
};

// What the full finite-element simulation needs beyond the material.
struct FullSpec {
  bool finite = false;             // finite strain, of the energy of exponential_law()
  double stiffening = 0;           // its exponent b
  std::vector<MaxwellTerm> terms;  // of the whole body
  double curvature = 0;            // of the tool's tip [1/m]; 0: flat
  double friction = std::numeric_limits<double>::infinity();  // infinite: what touches sticks
};

// A curve that an effect with no law has learned, and its derivatives by the effect's values.
struct CurvePoint {
  double x = 0, y = 0;
  Eigen::VectorXd by;
  double form = 0;  // by which y may err since the curve has few knots
};
struct EffectCurve {
  std::string name, x, x_unit, y, y_unit;  // name: of the axis, "" where there is one curve only
  std::vector<CurvePoint> points;          // ascending x, SI
};

class EffectStep;
struct StepContext;

class Effect {
 public:
  virtual ~Effect() = default;
  virtual const EffectCard& card() const = 0;

  // Body and support effects: fills in what the stiffness solutions need.
  virtual void describe(const Values& values, MaterialSpec& material) const;
  // Motion effects: changes the displacements that all later effects see.
  virtual void move(const PressView& press, const Values& values, Motion& motion) const;
  // Other effects: changes the force and carries all columns of the derivative through; adds its
  // own.
  virtual void apply(const PressView& press, const Values& values, Signal& signal) const;
  // move() and apply() without derivatives, sample by sample (effects/effect_step.h). Null: all
  // that it does is in the material.
  virtual std::unique_ptr<EffectStep> step(const Values& values, const StepContext& context) const;
  // The effect as a linear body with Maxwell elements: what it has of these beyond the material
  // (describe()), for the modulus of region 0 [Pa]. False: it has no such form.
  virtual bool relaxation(const Values& values, double modulus,
                          std::vector<MaxwellTerm>& terms) const;
  // Why fitted values are not what the effect is meant for, given the points that were pressed;
  // "" when they are.
  virtual std::string implausible(const Values& values, const std::vector<Vec3>& pressed) const;
  // The effect as the full simulation solves it, beyond the material. Default: what describes the
  // body alone, or has a relaxation() form. False: it has no such form.
  virtual bool full(const Values& values, double modulus, FullSpec& spec) const;
  // Starts for a fit of `terms` terms, each as many values as one parameter set. Default: the
  // card's.
  virtual std::vector<std::vector<double>> starts(const DataSummary& data, int terms) const;
  // What is known of it before a fit, as values of one parameter set: the effect is in the first
  // model and not fitted. Default: nothing.
  virtual std::vector<double> known(const DataSummary& data) const;
  // Whether such data leave it in doubt from the start: the effect is in the first model and
  // fitted, so that what it hides is in the others' uncertainties. Default: no.
  virtual bool doubted(const DataSummary& data) const;
  // What it has learned. Default: nothing, it has a law.
  virtual std::vector<EffectCurve> curves(const Values& values) const;
  // Bounds of one parameter set for a fit to such data, within the card's. Default: the card's.
  virtual std::vector<std::pair<double, double>> limits(const DataSummary& data) const;
};

// For describe(): a feature whose values are the card's parameters in their order.
void add_feature(Feature kind, const Values& values, const EffectCard& card,
                 MaterialSpec& material);

// The value of a parameter by name; assert when absent.
const ParameterValue& find_value(const Values& values, const std::string& name);

}  // namespace hapsim
