#include "realtime/force_loop.h"

#include <algorithm>
#include <cmath>

#include "material/maxwell_memory.h"
#include "realtime/direction_doubt.h"

namespace hapsim {
namespace {

// Of the linear law, in tool radii. Elements at finite strain agree with it along the normal as far
// as with the law of finite strain, which is straight there where the material does not stiffen. To
// the side they stiffen with depth, so that the force is off by 7.5 % where it is worst.
constexpr LawRange kLinearLaw{1.6, 0.5};

// Standard uncertainty of what the inside does otherwise (inside_memory.h), over the force of that,
// and where it is not known at all, over the force by what is remembered.
constexpr double kInsideDoubt = 0.3, kInsideUnknown = 0.5;

// The displacement from which on a memory is taken as a multiple of what is now, squared, over the
// tool's radius.
constexpr double kMultipleFrom = 0.01;

// Numbers that a loop keeps of a state that is remembered, and of each memory.
constexpr std::size_t kStrainNumbers = kMemoryTerms + kInsideFields * kInsideNow;
// And of a tool that slips, as slide() has them.
constexpr std::size_t kSlipNumbers = StrainSlip::State::kNumbers;

template <class Steps>
LawRange law_of(const Steps& steps, double radius) {
  LawRange law = kLinearLaw;
  for (const auto& s : steps) {
    const LawRange own = s.step->law();
    law = {std::max(law.into, own.into), std::max(law.along, own.along)};
  }
  return {radius * law.into, radius * law.along};
}

// A tool that has touched is let go where the last of the effects lets it go.
template <class Steps>
ToolLoopOptions within_reach(ToolLoopOptions options, const Steps& steps) {
  for (const auto& s : steps)
    options.contact.release = std::max(options.contact.release, s.step->reach());
  return options;
}

}  // namespace

std::vector<ForceLoop::Running> ForceLoop::steps_of(const PreparedBody& body,
                                                    const ToolLoopOptions& options) {
  const StepContext context{body.tool_radius(), body.modulus(), body.heals()};
  std::vector<Running> steps;
  std::size_t memory = 0;
  for (const EffectInstance& i : body.effects()) {
    const Stage stage = i.effect->card().stage;
    if (stage == Stage::kSensor && !options.sensor) continue;
    if (body.is_regional() && relaxes(i)) continue;  // the elements stand for all that relaxes
    // Sampled elements stand for the law of finite strain, and for what relaxes beside it.
    if (body.large_strain() != nullptr && (is_finite_strain(i) || relaxes(i))) continue;
    // And for the tool that slips, where they were pressed by one.
    if (body.large_strain() != nullptr && body.large_strain()->slip() &&
        std::isfinite(flat_friction(i)))
      continue;
    std::unique_ptr<EffectStep> step = i.effect->step(i.values, context);
    if (!step) continue;
    const std::size_t needed = step->memory();
    steps.push_back({std::move(step), stage, memory});
    memory += needed;
  }
  return steps;
}

ForceLoop::ForceLoop(const PreparedBody& body, const ToolLoopOptions& options)
    : ForceLoop(body, options, steps_of(body, options)) {}

ForceLoop::ForceLoop(const PreparedBody& body, const ToolLoopOptions& options,
                     std::vector<Running> steps)
    : ToolLoop(&body.distance(), within_reach(options, steps)),
      body_(body),
      steps_(std::move(steps)) {
  if (body.large_strain() == nullptr) set_law(law_of(steps_, body.tool_radius()));
  state_.h.fill(Vec3::Zero());
  state_.driver.fill(Vec3::Zero());
  state_.maxwell.fill(Eigen::Matrix3d::Zero());
  if (!steps_.empty()) strain_memory_ = steps_.back().memory + steps_.back().step->memory();
  const LargeStrain* strain = body.large_strain();
  const bool slips = strain != nullptr && strain->slip();
  touches_otherwise_ =
      strain != nullptr &&
      std::any_of(body.effects().begin(), body.effects().end(),
                  [slips](const EffectInstance& i) { return touches_otherwise(i, slips); });
  const bool remembers = strain != nullptr && strain->remembers();
  before_.resize(remembers ? (1 + body.terms().size()) * kStrainNumbers : 0);
  slip_memory_ = strain_memory_ + before_.size();
  state_.memory.resize(slip_memory_ + (slips ? kSlipNumbers : 0), 0);
}

ForceLoopState ForceLoop::state() const {
  ForceLoopState state = state_;
  state.tool = tool();
  return state;
}

void ForceLoop::restore(const ForceLoopState& state) noexcept {
  state_ = state;
  restore_tool(state.tool);
  set_quality(state_.uncertainty, state_.sampled);
  if (!state_.placed) return;
  if (body_.large_strain() != nullptr) take_strain(state_.place.normal);
  for (const Running& s : steps_) s.step->take_place(state_.place);
}

void ForceLoop::take_place(const Place& place) noexcept {
  const Vec3 before = state_.placed ? state_.place.normal : Vec3(Vec3::Zero());
  state_.place = body_.facts().at(place.face, place.point, place.normal);
  state_.placed = true;
  const StiffnessField& field = body_.field();
  const FieldEntry entry = field.entry_at(field.locate(place.face, place.point));
  state_.uncertainty = entry.uncertainty;
  state_.sampled = entry.sampled;
  set_quality(state_.uncertainty, state_.sampled);
  if (body_.is_regional()) body_.maxwell_at(place.face, place.point, state_.maxwell.data());
  if (body_.large_strain() != nullptr) take_strain(before);
  for (const Running& s : steps_) s.step->take_place(state_.place);
}

// `before`: the normal that the axes of what is remembered are of; zero: there is none.
void ForceLoop::take_strain(const Vec3& before) noexcept {
  strain_ = body_.large_strain()->at(state_.place);
  if (!body_.large_strain()->remembers()) return;
  remembered_.frame = state_.frame;
  body_.large_strain()->remember(strain_, before, remembered_);
  state_.frame = remembered_.frame;
}

LargeStrain::Force ForceLoop::strained(const StepSample& sample, const Vec3& u) noexcept {
  LargeStrain::Force f = body_.large_strain()->force(strain_, u);
  if (body_.large_strain()->remembers()) strain_memory(sample, u, f);
  return f;
}

// `doubt`: what sampled elements leave of it, relative.
Vec3 ForceLoop::body_force(const StepSample& sample, const Vec3& u, double& doubt) noexcept {
  Vec3 f = -(state_.place.contact.K * u);
  if (body_.large_strain() != nullptr) {
    const LargeStrain::Force found =
        body_.large_strain()->slip() ? slide(sample, u) : strained(sample, u);
    f = -found.f;
    doubt = found.doubt;
    if (!found.within || touches_otherwise_) mark_beyond_law();
  }
  if (body_.is_regional()) f += regional_memory(sample, u);
  return f;
}

StepSample ForceLoop::next_sample(double t, const Vec3& u, bool in_air) noexcept {
  if (!std::isfinite(t)) t = state_.t;
  state_.session = state_.number == 0 ? t : std::min(state_.session, t);
  StepSample sample;
  sample.first = !state_.begun;
  if (sample.first) {
    ++state_.number;
    state_.press = state_.t = t;
    state_.begun = true;
  }
  const double before = state_.t - state_.press;
  state_.t = std::max(state_.t, t);
  sample.number = state_.number;
  sample.t = state_.t - state_.press;
  sample.dt = sample.t - before;
  sample.session = state_.t - state_.session;
  sample.in_air = in_air;
  sample.temperature = temperature();
  sample.recorded = sample.u = u;
  sample.moduli = moduli_;
  sample.times = times_;
  return sample;
}

Vec3 ForceLoop::regional_memory(const StepSample& sample, const Vec3& u) noexcept {
  Vec3 force = Vec3::Zero();
  for (std::size_t i = 0; i < body_.terms().size(); ++i) {
    Vec3& h = state_.h[i];
    const Vec3 driver = -(state_.maxwell[i] * u);
    if (sample.first) {
      h = driver;  // relaxed until now, then a jump
    } else {
      const MemoryStep s = memory_step(sample.dt, times_ * body_.terms()[i].tau);
      h = s.a * h + s.c * (driver - state_.driver[i]);
    }
    state_.driver[i] = driver;
    force += moduli_ * h;
  }
  return force;
}

// Memories of the monomials that stand for the stresses of the body, and of what its inside does
// otherwise.
void ForceLoop::strain_memory(const StepSample& sample, const Vec3& u,
                              LargeStrain::Force& f) noexcept {
  const MemoryPoint at = body_.large_strain()->memory_point(strain_, remembered_, u);
  double* const before = state_.memory.data() + strain_memory_;
  Eigen::Map<MemoryVector> m_before(before);
  Eigen::Map<InsideAmplitudes> x_before(before + kMemoryTerms);
  if (sample.first) x_before.setZero();
  MemoryVector all = MemoryVector::Zero();
  InsideAmplitudes faded = InsideAmplitudes::Zero();
  double at_once = 0;
  double* memory = before;
  for (const MaxwellTerm& term : body_.terms()) {
    memory += kStrainNumbers;
    Eigen::Map<MemoryVector> h(memory);
    Eigen::Map<InsideAmplitudes> z(memory + kMemoryTerms);
    const double share = moduli_ * term.share;
    if (sample.first) {
      h = at.m;  // relaxed until now, then a jump, of the inside too
      z.setZero();
      at_once += share;
    } else {
      const MemoryStep s = memory_step(sample.dt, times_ * term.tau);
      h = s.a * h + s.c * (at.m - m_before);
      z = s.a * z - s.c * x_before;
      at_once += share * s.c;
    }
    all += share * h;
    faded += share * z;
  }
  const InsideForce inside =
      sample.first ? InsideForce() : inside_force(remembered_.at.inside, at, all, faded, at_once);
  memory = before;
  for (const MaxwellTerm& term : body_.terms()) {
    memory += kStrainNumbers;
    Eigen::Map<InsideAmplitudes> z(memory + kMemoryTerms);
    z += (sample.first ? 1 : memory_step(sample.dt, times_ * term.tau).c) * inside.x;
  }
  m_before = at.m;
  x_before = inside.x;
  // What is a multiple of what is now is that of the static force, which is known better.
  const double multiple =
      all.head<3>().dot(at.m.head<3>()) / (at.m.head<3>().squaredNorm() + kMultipleFrom);
  const MemoryVector other = all - multiple * at.m;
  const Vec3 first = at.gradient * (remembered_.at.C * other),
             linear = remembered_.at.C.topLeftCorner<3, 3>() * other.head<3>();
  const double departs =
      inside.held ? kInsideDoubt * inside.f.norm() : kInsideUnknown * first.norm();
  f.f *= 1 + multiple;
  f.beyond *= 1 + multiple;
  // Of parts of the force, which may be far larger than what is left of it.
  const double size = std::hypot(f.doubt * f.f.norm(), strain_.memory * first.norm(),
                                 std::hypot(strain_.doubt * (first - linear).norm(), departs));
  f.f += remembered_.frame.transpose() * (first + inside.f);
  f.beyond += remembered_.frame.transpose() * (first - linear + inside.f);
  f.doubt = f.f.isZero(0) ? 0 : size / f.f.norm();
}

Vec3 ForceLoop::advance(double t, const Vec3& u, bool in_air) noexcept {
  StepSample sample = next_sample(t, u, in_air);
  double* memory = state_.memory.data();
  for (const Running& s : steps_) s.step->move(sample, memory + s.memory);
  const Vec3 pressed = in_air ? Vec3(Vec3::Zero()) : sample.u;
  double doubt = 0;
  Vec3 f = body_force(sample, pressed, doubt);
  auto s = steps_.begin();
  for (; s != steps_.end() && s->stage < Stage::kContact; ++s)
    s->step->apply(sample, memory + s->memory, f);
  f *= stiffness_;
  for (; s != steps_.end() && s->stage < Stage::kSensor; ++s)
    s->step->apply(sample, memory + s->memory, f);
  if (in_air) f.setZero();  // whatever the body remembers
  for (; s != steps_.end(); ++s) s->step->apply(sample, memory + s->memory, f);
  double share = 1;
  for (const Running& r : steps_) share = std::max(share, r.step->share_of_stiffness());
  const double place = state_.uncertainty * direction_doubt(state_.place.contact.K, pressed);
  set_quality(doubt > 0 ? std::hypot(place * share, doubt) : place * share, state_.sampled);
  return f;
}

}  // namespace hapsim
