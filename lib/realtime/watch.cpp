#include "realtime/watch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "estimate/least_squares.h"

namespace hapsim {
namespace {

constexpr double kReference = 0.5;  // of the cumulative sum, in standard deviations
constexpr double kKept = 10;        // [s]
constexpr double kPatience = 6;     // after the alarm at most [s]
constexpr double kNextPress = 2;    // [s]
constexpr std::size_t kPresses =
    3;  // one press tells a shift along its normal alone, and not from a bias
constexpr double kUsualShift = 0.005;  // [m]
constexpr double kTogether = 20;       // samples that err together
constexpr double kNothing = 0.05;      // a body that has lost all but this is gone
constexpr std::size_t kWindow = 200;   // samples that a change is named by
constexpr double kExplained = 9;       // chi-square a component above which nothing explains

// The limit h of a one-sided cumulative sum of independent unit normal values with reference k, at
// which false alarms come every `run` values: run = (e^(2kb) - 2kb - 1) / (2 k^2), b = h + 1.166.
double limit_for(double run) {
  const double k = kReference;
  double low = 0, high = 100;
  for (int i = 0; i < 100; ++i) {
    const double b = 0.5 * (low + high), x = 2 * k * b;
    (((std::exp(x) - x - 1) / (2 * k * k) < run) ? low : high) = b;
  }
  return std::max(low - 1.166, 0.5);
}

ToolLoopOptions loop_options() {
  return {};
}

}  // namespace

std::string change_name(Change change) {
  switch (change) {
    case Change::kMoved:
      return "moved";
    case Change::kGone:
      return "gone";
    case Change::kMaterial:
      return "material";
    case Change::kSensor:
      return "sensor";
    case Change::kUnexplained:
      return "unexplained";
    default:
      return "none";
  }
}

// Of a body that has moved the contact is found anew, by the tip's position against the body's.
class ModelWatch::Model {
 public:
  static Vec3 at(ForceLoop& loop, const MotionLine& line, bool fresh, const Correction& c) {
    if (c.gone) return c.bias;
    if (c.shift == Vec3::Zero()) {
      if (fresh) loop.begin(line.point);
      return c.stiffness * loop.press(line.t, line.u, line.in_air) + c.bias;
    }
    return c.stiffness * loop.step(line.t, line.point + line.u - c.shift) + c.bias;
  }
};

ModelWatch::ModelWatch(const PreparedBody& body, const WatchOptions& options)
    : body_(body),
      options_(options),
      loop_(body, loop_options()),
      before_(body, loop_options()),
      kept_(static_cast<std::size_t>(kKept * options.rate)) {
  limit_ = limit_for(3600 / options.block / std::max(options.false_alarms, 1e-9));
}

double ModelWatch::size(const Vec3& force) const {
  return std::sqrt(noise_ * noise_ + floor_ * floor_ * force.squaredNorm() / 3);
}

Vec3 ModelWatch::step(const MotionLine& line, const Vec3& measured) {
  const bool fresh = first_ || line.press != press_;
  first_ = false;
  press_ = line.press;
  Vec3 model = Model::at(loop_, line, fresh, correction_);
  if (share_ < 1) {
    share_ = std::min(1.0, share_ + 1 / (options_.blend * options_.rate));
    model = share_ * model + (1 - share_) * Model::at(before_, line, fresh, old_);
  }
  Sample& sample = kept_[count_++ % kept_.size()];
  sample = {line, measured, model};
  const bool touches = !line.in_air && model.norm() > 0;
  in_contact_ += touches ? 1 : 0;
  if (!learned_) {
    usual_.push_back({model.squaredNorm(), (measured - model).squaredNorm()});
    if (static_cast<double>(in_contact_) >= options_.learning * options_.rate) learn();
    return model;
  }
  block_squares_ += (measured - model).squaredNorm() / std::pow(size(model), 2);
  if (++block_samples_ >= std::lround(options_.block * options_.rate)) end_block(line.t);
  if (alarm_ >= 0 && count_ >= waits_until_) name();
  return model;
}

// Squared residuals straight in the squared force: noise^2 and floor^2, neither negative.
void ModelWatch::learn() {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [force, residual] : usual_) {
    n += 1;
    x += force;
    y += residual;
    xx += force * force;
    xy += force * residual;
  }
  const double spread = xx - x * x / n;
  double slope = spread > 0 ? (xy - x * y / n) / spread : 0;
  double base = (y - slope * x) / n;
  if (slope < 0) slope = 0, base = y / n;
  if (base <= 0) base = 1e-4 * y / n + 1e-300, slope = x > 0 ? y / x : 0;
  noise_ = std::sqrt(base / 3);
  floor_ = std::sqrt(slope);
  // The blocks' own mean and scatter, which tell how much neighbours go together.
  const auto length = static_cast<std::size_t>(std::lround(options_.block * options_.rate));
  double sum = 0, squares = 0, count = 0;
  std::vector<double> roots;
  for (std::size_t i = 0; i + length <= usual_.size(); i += length) {
    double mean = 0;
    for (std::size_t k = i; k < i + length; ++k)
      mean += usual_[k][1] / (base + slope * usual_[k][0]) / static_cast<double>(length);
    roots.push_back(std::cbrt(mean));
    sum += roots.back();
    squares += roots.back() * roots.back();
    count += 1;
  }
  mean_ = sum / count;
  const double variance = std::max(squares / count - mean_ * mean_, 1e-6) * count / (count - 1);
  double together = 0;
  for (std::size_t i = 1; i < roots.size(); ++i)
    together += (roots[i] - mean_) * (roots[i - 1] - mean_);
  const double rho = std::clamp(together / (variance * count), 0.0, 0.9);
  // A sum of values that go together scatters like one of independent ones that much wider; and
  // both are known from so many blocks only: two standard errors to the safe side.
  deviation_ = std::sqrt(variance * (1 + rho) / (1 - rho));
  const double independent = count * (1 - rho) / (1 + rho);
  mean_ += 2 * deviation_ / std::sqrt(count);
  deviation_ *= 1 + 2 / std::sqrt(2 * std::max(independent, 2.0));
  learned_ = true;
  usual_.clear();
  usual_.shrink_to_fit();
  change_ = count_;
}

double ModelWatch::usual_error() const {
  double squares = 0;
  long n = 0;
  for (std::size_t i = 0; i < std::min(count_, kept_.size()); ++i) {
    squares += std::pow(size(kept_[i].model), 2);
    ++n;
  }
  return n > 0 ? std::sqrt(squares / static_cast<double>(n)) : noise_;
}

void ModelWatch::end_block(double t) {
  const double root = std::cbrt(block_squares_ / (3 * static_cast<double>(block_samples_)));
  const auto length = static_cast<std::size_t>(block_samples_);
  block_squares_ = 0;
  block_samples_ = 0;
  if (alarm_ >= 0) return;
  const double value = (root - mean_) / deviation_;
  const bool was_zero = sum_ == 0;
  sum_ = std::max(0.0, sum_ + value - kReference);
  if (was_zero) change_ = count_ - length;
  if (sum_ <= limit_) return;
  alarm_ = t;
  waits_until_ = count_ + static_cast<std::size_t>(options_.evidence * options_.rate);
}

std::vector<Vec3> ModelWatch::forces(const std::vector<Sample>& window, const Correction& c) const {
  ForceLoop loop(body_, loop_options());
  std::vector<Vec3> result;
  result.reserve(window.size());
  for (std::size_t i = 0; i < window.size(); ++i)
    result.push_back(Model::at(loop, window[i].line,
                               i == 0 || window[i].line.press != window[i - 1].line.press, c));
  return result;
}

double ModelWatch::chi_square(const std::vector<Sample>& window, const Correction& c) const {
  const std::vector<Vec3> f = forces(window, c);
  double sum = 0;
  for (std::size_t i = 0; i < window.size(); ++i)
    if (window[i].counted)
      sum += (window[i].measured - f[i]).squaredNorm() / std::pow(size(window[i].measured), 2);
  return sum;
}

// The shift that explains the window best, from several starts; residuals over the size that the
// measured force gives them, so that it does not move with the shift.
Correction ModelWatch::fit_moved(const std::vector<Sample>& window) const {
  const ResidualFunction residuals = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                         Eigen::MatrixXd* J) {
    const auto at = [&](const Eigen::VectorXd& shift) {
      Correction c = correction_;
      c.gone = false;
      c.shift += shift;
      const std::vector<Vec3> f = forces(window, c);
      Eigen::VectorXd out(3 * static_cast<Eigen::Index>(window.size()) + 3);
      for (std::size_t i = 0; i < window.size(); ++i)
        out.segment<3>(3 * static_cast<Eigen::Index>(i)) =
            window[i].counted ? Vec3((window[i].measured - f[i]) / size(window[i].measured))
                              : Vec3(Vec3::Zero());
      // Ways that no press tells stay small.
      out.tail<3>() = shift / kUsualShift * std::sqrt(kTogether);
      return out;
    };
    r = at(x);
    if (J == nullptr) return;
    const double step = 2e-5;
    J->resize(r.size(), 3);
    for (Eigen::Index k = 0; k < 3; ++k) {
      Eigen::VectorXd y = x;
      y[k] += step;
      J->col(k) = (at(y) - r) / step;
    }
  };
  Vec3 normal = Vec3::UnitZ();
  for (const Sample& s : window)
    if (!s.line.in_air) normal = body_.distance().at(s.line.point).normal;
  Correction best = correction_;
  best.gone = false;
  double least = 1e300;
  std::vector<Vec3> starts{-0.004 * normal, -0.001 * normal, 0.001 * normal, 0.004 * normal};
  const Vec3 across = normal.unitOrthogonal();
  for (const Vec3& way : {across, Vec3(normal.cross(across))})
    for (const double along : {-0.004, 0.004}) starts.emplace_back(along * way);
  for (const Vec3& from : starts) {
    std::vector<Unknown> start(3);
    for (Eigen::Index k = 0; k < 3; ++k) {
      Unknown& unknown = start[static_cast<std::size_t>(k)];
      unknown.value = from[k];
      unknown.scale = 1e-3;
      unknown.lower = -0.02;
      unknown.upper = 0.02;
    }
    LeastSquaresOptions options;
    options.max_iterations = 30;
    options.step_tolerance = 1e-3;
    const LeastSquaresResult fit = minimise(start, residuals, options);
    if (fit.sum_of_squares >= least) continue;
    least = fit.sum_of_squares;
    best.shift = correction_.shift + Vec3(fit.x[0], fit.x[1], fit.x[2]);
  }
  return best;
}

void ModelWatch::name() {
  // Every so many samples of the change, from the beginning of the press in which it fell, so that
  // what the body remembers is known.
  const std::size_t oldest = count_ - std::min(count_, kept_.size());
  const auto kept = [&](std::size_t i) -> const Sample& { return kept_[i % kept_.size()]; };
  std::size_t from = std::max(change_, oldest);
  // What changed within a press (a tool stuck to a body that moves) is told by the next one, when
  // there is one soon.
  std::size_t next = from;
  while (next < count_ && kept(next).line.press == kept(from).line.press) ++next;
  const auto evidence = static_cast<std::size_t>(options_.evidence * options_.rate);
  if (next + evidence <= count_) {
    from = next;
  } else if (kept(count_ - 1).line.t - alarm_ < kNextPress) {
    waits_until_ = count_ + evidence / 2;
    return;
  }
  std::size_t begin = from;
  while (begin > oldest && kept(begin - 1).line.press == kept(from).line.press) --begin;
  std::vector<Sample> window;
  const std::size_t every = std::max<std::size_t>(1, (count_ - from) / kWindow);
  for (std::size_t i = begin; i < count_; i += every) {
    window.push_back(kept(i));
    window.back().counted = i >= from;
  }
  const auto touches = [](const Sample& s) {
    return s.counted && !s.line.in_air && s.line.u.norm() > 0;
  };
  if (std::none_of(window.begin(), window.end(), touches) &&
      count_ < waits_until_ + kept_.size() / 2)
    return;  // the air alone tells less; wait for contact a while

  struct Hypothesis {
    Change change;
    Correction correction;
    int parameters;
  };
  std::vector<Hypothesis> all;
  const auto size_now = [&](const Sample& s) { return std::pow(size(s.measured), 2); };
  {
    Correction known = correction_;  // what was gone may be back
    known.gone = false;
    Correction c = known;  // of all moduli
    const std::vector<Vec3> f = forces(window, c);
    double fm = 0, ff = 0;
    for (std::size_t i = 0; i < window.size(); ++i) {
      if (!window[i].counted) continue;
      const Vec3 body = f[i] - c.bias;
      fm += body.dot(window[i].measured - c.bias) / size_now(window[i]);
      ff += body.squaredNorm() / size_now(window[i]);
    }
    if (ff > 0 && fm > kNothing * ff) {
      c.stiffness *= fm / ff;
      all.push_back({Change::kMaterial, c, 1});
    }
    c = known;  // of the sensor's zero
    Vec3 mean = Vec3::Zero();
    double weight = 0;
    for (std::size_t i = 0; i < window.size(); ++i) {
      if (!window[i].counted) continue;
      mean += (window[i].measured - f[i]) / size_now(window[i]);
      weight += 1 / size_now(window[i]);
    }
    c.bias += mean / weight;
    all.push_back({Change::kSensor, c, 3});
    c = correction_;
    c.gone = true;
    all.push_back({Change::kGone, c, 0});
    all.push_back({Change::kMoved, fit_moved(window), 3});
  }
  const double n =
      3 * static_cast<double>(std::count_if(window.begin(), window.end(),
                                            [](const Sample& s) { return s.counted; }));
  const Hypothesis* best = nullptr;
  double least = 1e300, chi = 0;
  for (const Hypothesis& h : all) {
    const double x = chi_square(window, h.correction);
    // The log of the mean square, so that an error of the model that is common to all does not
    // decide by its size.
    const double criterion = n * std::log(x / n) + h.parameters * std::log(n);
    if (criterion >= least) continue;
    least = criterion;
    best = &h;
    chi = x / n;
  }
  const bool explained = chi < kExplained;
  std::size_t presses = 0;
  std::int32_t last_press = 0;
  for (std::size_t i = 0; i < window.size(); ++i)
    if (touches(window[i]) && (presses == 0 || window[i].line.press != last_press)) {
      last_press = window[i].line.press;
      ++presses;
    }
  const bool plain = best->change == Change::kMaterial || best->change == Change::kGone;
  if ((!explained || !plain) && presses < kPresses &&
      kept(count_ - 1).line.t - alarm_ < kPatience) {
    waits_until_ = count_ + evidence;
    return;
  }
  WatchEvent event;
  event.begun = kept(from).line.t;
  event.alarm = alarm_;
  event.named = kept(count_ - 1).line.t;
  event.error_before = usual_error();
  event.change = explained ? best->change : Change::kUnexplained;
  event.correction = correction_;
  if (event.change != Change::kUnexplained) event.correction = best->correction;
  double squares = 0;
  const std::vector<Vec3> f = forces(window, event.correction);
  for (std::size_t i = 0; i < window.size(); ++i)
    if (window[i].counted) squares += (window[i].measured - f[i]).squaredNorm();
  event.error_with = std::sqrt(squares / n);
  events_.push_back(event);
  if (options_.adapts && event.change != Change::kUnexplained) {
    old_ = correction_;
    before_.restore(loop_.state());
    correction_ = event.correction;
    // The loop of the corrected body as it stands now.
    for (std::size_t i = begin; i < count_; ++i)
      Model::at(loop_, kept(i).line, i == begin || kept(i).line.press != kept(i - 1).line.press,
                correction_);
    share_ = 0;
  }
  alarm_ = -1;
  sum_ = 0;
  change_ = count_;
}

}  // namespace hapsim
