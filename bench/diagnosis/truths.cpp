#include "truths.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "effects/catalogue.h"
#include "fit/extend.h"

namespace hapsim::bench {
namespace {

constexpr double kModulus = 1.5e4, kPoisson = 0.42;   // [Pa], 1
constexpr double kRelaxing = 4e3, kRelaxation = 0.6;  // [Pa], [s]

using Strengths = std::function<std::vector<double>(double)>;
using Change =
    std::function<void(const Episode&, double strength, Random&, Eigen::Ref<Eigen::VectorXd>)>;

Model with(Model model, const std::string& effect, const std::vector<double>& values) {
  const Effect& e = require_effect(effect);
  if (values.size() % e.card().parameters.size() != 0)
    fail_usage("a truth has another number of values than " + effect, "see truths.cpp");
  const int terms = static_cast<int>(values.size() / e.card().parameters.size());
  for (const Parameter& p : effect_rows(e, terms, values)) model.parameters.push_back(p);
  return model;
}

// A truth in the catalogue's own form.
Truth of_model(const std::string& name, const std::string& effect, double most,
               const std::function<Model(const Model&, double)>& model) {
  Truth truth;
  truth.name = name;
  if (!effect.empty()) truth.effects = {effect};
  truth.most = most;
  truth.model = model;
  truth.forces = [model](const Experiment& w, const Model& base, double s, Random&) {
    return forces_of(w, s > 0 ? model(base, s) : base);
  };
  return truth;
}

// The effect with values by strength.
Truth own_form(const std::string& name, const std::string& effect, double most,
               const Strengths& values) {
  return of_model(name, effect, most, [effect, values](const Model& base, double s) {
    return with(base, effect, values(s));
  });
}

// The effect with values of a list: strength k is the k-th, from 1.
Truth listed(const std::string& effect, const std::vector<std::vector<double>>& values) {
  Truth truth = own_form(effect, effect, static_cast<double>(values.size()),
                         [values](double s) { return values[static_cast<std::size_t>(s) - 1]; });
  truth.sizes = static_cast<int>(values.size());
  return truth;
}

// A change of the base's forces, press by press, in a form that the catalogue does not have.
Truth other_form(const std::string& name, const std::string& effect, double most,
                 const Change& change) {
  Truth truth;
  truth.name = name;
  truth.effects = {effect};
  truth.most = most;
  truth.forces = [change](const Experiment& w, const Model& base, double s, Random& random) {
    Eigen::VectorXd f = forces_of(w, base);
    Eigen::Index at = 0;
    for (const Episode& e : w.dataset.episodes) {
      const auto n = 3 * static_cast<Eigen::Index>(e.rows.size());
      change(e, s, random, f.segment(at, n));
      at += n;
    }
    return f;
  };
  return truth;
}

// Each position's factor on its forces.
Truth by_place(const std::string& name, const std::function<double(const Vec3&, double)>& factor) {
  Truth truth;
  truth.name = name;
  truth.effects = {"regions"};
  truth.most = 3;
  truth.forces = [factor](const Experiment& w, const Model& base, double s, Random&) {
    Eigen::VectorXd f = forces_of(w, base);
    Eigen::Index at = 0;
    for (const Episode& e : w.dataset.episodes) {
      const auto n = 3 * static_cast<Eigen::Index>(e.rows.size());
      f.segment(at, n) *= factor(w.dataset.positions[e.position], s);
      at += n;
    }
    return f;
  };
  return truth;
}

// One half of the body stiffer or softer than the other; each size costs finite elements.
Truth halves() {
  static const std::vector<double> kStiffer{0.25, 0.85, 0.45, -0.3, 0.65, 0.35, 0.75, 0.55};
  Truth truth = of_model("regions", "regions", 0, [](const Model& base, double size) {
    const double s = kStiffer[static_cast<std::size_t>(size) - 1];
    Model model = base;
    Parameter stiffer = *model.find("elastic", 0, "E");
    stiffer.region = 1;
    stiffer.value *= 1 + s;
    model.parameters.insert(model.parameters.begin() + 1, stiffer);
    for (const int region : {0, 1})
      for (Parameter row :
           effect_rows(require_effect("regions"), 1, {region == 0 ? -0.02 : 0.02, 0, 0})) {
        if (row.name == "local") continue;
        row.name = row.name.substr(0, 1) + "1";
        row.region = region;
        model.parameters.push_back(row);
      }
    return model;
  });
  truth.most = truth.sizes = static_cast<int>(kStiffer.size());
  return truth;
}

std::vector<Truth> own_forms() {
  std::vector<Truth> t;
  t.push_back(own_form("viscoelastic", "viscoelastic", 5, [](double s) {
    return std::vector<double>{s * kModulus, 0.6};
  }));
  t.push_back(own_form("viscoelastic-3-terms", "viscoelastic", 5, [](double s) {
    return std::vector<double>{s * kModulus, 0.05, s * kModulus, 0.4, s * kModulus, 3};
  }));
  t.push_back(own_form("fractional", "fractional", 5, [](double s) {
    return std::vector<double>{s * kModulus, 0.25, 0.05};
  }));
  t.push_back(own_form("poroelastic", "poroelastic", 1, [](double s) {
    return std::vector<double>{0.5 - 0.5 * s, 1e-5};
  }));
  t.push_back(own_form("qlv", "qlv", 5, [](double s) {
    return std::vector<double>{s * kModulus, 0.6, 1};
  }));
  t.push_back(own_form("damper", "damper", 100, [](double s) {
    return std::vector<double>{s, 0};
  }));
  t.push_back(own_form("damper-of-the-body", "damper", 10, [](double s) {
    return std::vector<double>{0, s};
  }));
  t.push_back(own_form("hyperelastic", "hyperelastic", 1.2, [](double s) {
    return std::vector<double>{s, std::min(1.0, 5 * s)};
  }));
  t.push_back(own_form("tip", "tip", 250, [](double s) { return std::vector<double>{s}; }));
  t.push_back(own_form("temperature", "temperature", 0.5, [](double s) {
    return std::vector<double>{s, 25};
  }));
  t.push_back(own_form("softening", "softening", 0.9, [](double s) {
    return std::vector<double>{s, 3, 1, 2, 0};
  }));
  t.push_back(own_form("ageing", "softening", 0.01, [](double s) {
    return std::vector<double>{0, 2, 1, 2, s};
  }));
  t.push_back(
      own_form("backlash", "backlash", 3e-3, [](double s) { return std::vector<double>{s}; }));
  t.push_back(own_form("plastic", "plastic", 0.4, [](double s) {
    return std::vector<double>{s, 2e-4};
  }));
  t.push_back(
      own_form("friction", "friction", 50, [](double s) { return std::vector<double>{1 / s}; }));
  t.push_back(own_form("adhesion", "adhesion", 5, [](double s) {
    return std::vector<double>{s, 3e-4, 0.1};
  }));
  t.push_back(own_form("adhesion-constant", "adhesion", 5, [](double s) {
    return std::vector<double>{s, 1e-4, 1};
  }));
  t.push_back(own_form("sensor-rotation", "sensor-rotation", 0.7, [](double s) {
    return std::vector<double>{s, -0.6 * s, 0.3 * s};
  }));
  t.push_back(own_form("sensor-gain-x", "sensor-gain", 3, [](double s) {
    return std::vector<double>{1 + s, 1};
  }));
  t.push_back(own_form("sensor-gain-z", "sensor-gain", 3, [](double s) {
    return std::vector<double>{1 / (1 + s), 1 / (1 + s)};
  }));
  t.push_back(own_form("sensor-crosstalk", "sensor-crosstalk", 1, [](double s) {
    return std::vector<double>{s, -s, -0.5 * s, s, 0.7 * s, s};
  }));
  t.push_back(own_form("motion-scale", "motion-scale", 3, [](double s) {
    return std::vector<double>{1, 1 + s};
  }));
  t.push_back(own_form("motion-rotation", "motion-rotation", 0.7, [](double s) {
    return std::vector<double>{s, -0.6 * s, 0.3 * s};
  }));
  t.push_back(own_form("arm-compliance", "arm-compliance", 0.01, [](double s) {
    return std::vector<double>{s, s, 0.5 * s};
  }));
  t.push_back(own_form("drag", "drag", 5, [](double s) {
    return std::vector<double>{0, 0, s, 1e-5};
  }));
  t.push_back(own_form("tool-inertia", "tool-inertia", 50,
                       [](double s) { return std::vector<double>{s}; }));
  t.push_back(own_form("tool-radius", "tool-radius", 4,
                       [](double s) { return std::vector<double>{1 + s}; }));
  t.push_back(own_form("sensor-curve", "sensor-curve", 1, [](double s) {
    return std::vector<double>{-s, 0, -s, 0};
  }));
  t.push_back(own_form("sensor-lag", "sensor-lag", 1, [](double s) {
    return std::vector<double>{s, 0};
  }));
  t.push_back(own_form("sensor-delay", "sensor-lag", 1, [](double s) {
    return std::vector<double>{1e-5, s};
  }));
  // Clipping is none of these: their noise comes after the sensor, and it cuts the noise off.
  t.push_back(own_form("sensor-hysteresis", "sensor-hysteresis", 0.5, [](double s) {
    return std::vector<double>{s, 0.2};
  }));
  t.push_back(own_form("clock", "clock", 1, [](double s) { return std::vector<double>{s, 0}; }));
  t.push_back(own_form("filter", "filter", 2, [](double s) {
    return std::vector<double>{1 / s, 0.7};
  }));
  t.push_back(own_form("breathing", "breathing", 5e-3, [](double s) {
    return std::vector<double>{0, 0.3 * s, s, 0.23, 1};
  }));
  t.push_back(own_form("sensor-bias", "sensor-bias", 5, [](double s) {
    return std::vector<double>{s, -0.5 * s, s};
  }));
  t.push_back(own_form("sensor-drift", "sensor-drift", 0.1, [](double s) {
    return std::vector<double>{0, 0, 0, 0.3 * s, -0.5 * s, s};
  }));
  t.push_back(own_form("sensor-settling", "sensor-settling", 5, [](double s) {
    return std::vector<double>{0.3 * s, -0.5 * s, s, 60, 0, 0, 0};
  }));
  t.push_back(own_form("sensor-hum", "sensor-hum", 5, [](double s) {
    return std::vector<double>{0.3 * s, 0, s, 0, 0.5 * s, 0, 1.7};
  }));
  t.push_back(own_form("deadband-short", "deadband", 0.25, [](double s) {
    return std::vector<double>{s, 1};
  }));
  t.push_back(own_form("deadband-true", "deadband", 0.25, [](double s) {
    return std::vector<double>{s, 0};
  }));
  return t;
}

// Sizes of features, which finite elements solve one by one.
std::vector<Truth> features() {
  std::vector<Truth> t;
  t.push_back(listed("layer", {{2e-3, 5},
                               {1.5e-3, 7},
                               {3e-3, 4},
                               {2e-3, 10},
                               {2e-3, 0.2},
                               {3e-3, 0.2},
                               {4e-3, 4},
                               {1e-3, 15}}));
  t.push_back(
      listed("pre-stress", {{4e-4}, {8e-4}, {3e-4}, {1e-3}, {6e-4}, {5e-4}, {7e-4}, {2e-3}}));
  t.push_back(listed("anisotropic", {{2, 1, 1.4, 0.3},
                                     {2.5, 1, 1.4, 0.3},
                                     {0.5, 1, 1.4, 1.2},
                                     {3, 1, 1.2, -0.6},
                                     {2, 1, 0.6, 2},
                                     {0.4, 1, 0.3, 0},
                                     {3, 1, 0.9, -1.5},
                                     {2.5, 1, 0, 0}}));
  t.push_back(listed("base", {{0.5, 0.5, 0},
                              {0.5, 2, 0},
                              {0.6, -1, 0},
                              {0.45, -2.5, 0},
                              {0.55, 1.2, 0},
                              {0.5, 3, 0},
                              {0.6, 0, 0},
                              {0.4, -0.3, 0}}));
  // Balls below pressed places, whose tops stay 3 mm under the surface.
  t.push_back(listed("inclusion", {{0.0139, 0.0120, 0.0222, 9e-3, 10},
                                   {-0.0113, 0.0069, 0.0243, 9e-3, 10},
                                   {0.0233, -0.0097, 0.0200, 9e-3, 8},
                                   {0.0154, -0.0220, 0.0165, 8e-3, 10},
                                   {0.0306, 0.0073, 0.0168, 9e-3, 12},
                                   {-0.0076, 0.0185, 0.0187, 10e-3, 8},
                                   {-0.0245, -0.0028, 0.0199, 10e-3, 10},
                                   {0.0017, -0.0126, 0.0225, 10e-3, 12}}));
  return t;
}

// Several effects at once, of which each alone would be seen.
Truth together(const std::vector<std::string>& parts) {
  Truth truth;
  truth.name = fmt::format("{}", fmt::join(parts, "&"));
  truth.parts = parts;
  return truth;
}
Truth both(const std::string& a, const std::string& b) {
  return together({a, b});
}

// Three at once, 10, 5 and 3 times the noise.
std::vector<Truth> triples() {
  std::vector<Truth> t;
  const std::vector<std::vector<std::string>> parts{
      {"viscoelastic", "hyperelastic", "friction"},
      {"viscoelastic", "sensor-drift", "tip"},
      {"hyperelastic", "sensor-lag", "temperature"},
      {"viscoelastic", "softening", "sensor-rotation"},
      {"sensor-drift", "friction", "temperature"},
      {"viscoelastic", "sensor-gain-x", "backlash"},
      {"hyperelastic", "viscoelastic", "sensor-drift"},
      {"viscoelastic", "sensor-bias", "tip"},
      {"sensor-rotation", "softening", "sensor-lag"},
      {"viscoelastic", "temperature", "adhesion"},
  };
  for (const std::vector<std::string>& three : parts) {
    t.push_back(together(three));
    t.back().levels = {10, 5, 3};
  }
  return t;
}

std::vector<Truth> pairs() {
  return {both("viscoelastic", "friction"),     both("viscoelastic", "regions"),
          both("hyperelastic", "viscoelastic"), both("sensor-drift", "viscoelastic"),
          both("regions", "sensor-bias"),       both("sensor-rotation", "viscoelastic"),
          both("temperature", "sensor-gain-x"), both("softening", "viscoelastic"),
          both("sensor-lag", "hyperelastic"),   both("friction", "sensor-drift"),
          both("backlash", "temperature"),      both("adhesion", "regions")};
}

// Nothing hidden, in ways that look like something.
std::vector<Truth> nothings() {
  const Truth plain = own_form("nothing", "", 0, [](double) { return std::vector<double>(); });
  std::vector<Truth> t(9, plain);
  t[1].name = "nothing-correlated";
  t[1].noise = NoiseKind::kCorrelated;
  t[2].name = "nothing-outliers";
  t[2].noise = NoiseKind::kOutliers;
  t[3].name = "nothing-six-presses";
  t[3].presses = 6;
  t[4].name = "nothing-open";
  t[4].open = true;
  t[4].base = {"slack"};
  t[5].name = "nothing+relaxing";
  t[5].base = {"viscoelastic"};
  t[6].name = "nothing-one-press";
  t[6].presses = 1;
  t[7].name = "nothing-one-press-correlated";
  t[7].presses = 1;
  t[7].noise = NoiseKind::kCorrelated;
  t[8].name = "nothing-noisy";
  t[8].noisier = 5;  // some 5 % of the largest force
  return t;
}

std::vector<Truth> other_forms() {
  std::vector<Truth> t;
  t.push_back(halves());
  t.push_back(by_place("regions-gradual", [](const Vec3& p, double s) {
    return std::exp(s * (p.x() + 0.5 * p.y()) / 0.05);
  }));
  t.push_back(
      other_form("tare", "tare", 5,
                 [](const Episode&, double s, Random& random, Eigen::Ref<Eigen::VectorXd> f) {
                   const Vec3 b(random.normal(), random.normal(), random.normal());
                   for (Eigen::Index i = 0; i < f.size(); i += 3) f.segment<3>(i) += s * b;
                 }));
  t.push_back(other_form("softening-by-cycle", "softening", 0.9,
                         [](const Episode& e, double s, Random&, Eigen::Ref<Eigen::VectorXd> f) {
                           if (e.view.past_depth > 0) f *= 1 - s;
                         }));
  t.push_back(other_form("hyperelastic-by-depth", "hyperelastic", 2,
                         [](const Episode& e, double s, Random&, Eigen::Ref<Eigen::VectorXd> f) {
                           for (std::size_t i = 0; i < e.view.size(); ++i) {
                             const double d = e.view.u[i].dot(e.view.normal) / e.view.radius;
                             f.segment<3>(3 * static_cast<Eigen::Index>(i)) *= std::exp(s * d * d);
                           }
                         }));
  // A cone of height s on a flat tool: the contact's radius grows like the depth.
  t.push_back(other_form("tip-cone", "tip", 5e-3,
                         [](const Episode& e, double s, Random&, Eigen::Ref<Eigen::VectorXd> f) {
                           for (std::size_t i = 0; i < e.view.size(); ++i) {
                             const double z = std::max(0.0, -e.view.u[i].dot(e.view.normal));
                             f.segment<3>(3 * static_cast<Eigen::Index>(i)) *=
                                 z < s ? z / (2 * s) : 1 - s / (2 * z);
                           }
                         }));
  t.push_back(other_form("sensor-curve-of-size", "sensor-curve", 1,
                         [](const Episode&, double s, Random&, Eigen::Ref<Eigen::VectorXd> f) {
                           for (Eigen::Index i = 0; i < f.size(); i += 3)
                             f.segment<3>(i) *= 1 - s * f.segment<3>(i).norm();
                         }));
  t.push_back(other_form("temperature-linear", "temperature", 0.19,
                         [](const Episode& e, double s, Random&, Eigen::Ref<Eigen::VectorXd> f) {
                           for (std::size_t i = 0; i < e.view.size(); ++i)
                             f.segment<3>(3 * static_cast<Eigen::Index>(i)) *=
                                 1 - s * (e.view.temperature[i] - 25);
                         }));
  t.push_back(other_form("sensor-lag-of-two", "sensor-lag", 1,
                         [](const Episode& e, double s, Random&, Eigen::Ref<Eigen::VectorXd> f) {
                           Signal signal{f, Eigen::MatrixXd(f.size(), 0)};
                           const Values tau{{0, "tau", std::max(s, 1e-9), -1}, {0, "delay", 0, -1}};
                           const Effect& lag = require_effect("sensor-lag");
                           lag.apply(e.view, tau, signal);
                           lag.apply(e.view, tau, signal);
                           f = signal.f;
                         }));
  return t;
}

}  // namespace

std::vector<Truth> all_truths() {
  std::vector<Truth> truths = nothings();
  std::vector<Truth> single = own_forms();
  for (Truth& t : other_forms()) single.push_back(std::move(t));
  truths.insert(truths.end(), single.begin(), single.end());
  for (Truth& t : features()) truths.push_back(std::move(t));
  // The same on a body that relaxes, which the diagnosed model knows.
  for (Truth t : single) {
    if (t.effects.front() == "viscoelastic") continue;
    t.name += "+relaxing";
    t.base = {"viscoelastic"};
    truths.push_back(t);
  }
  // Air samples that nobody marked: the body cannot pull there.
  Truth slack = own_form("slack", "slack", 1, [](double) { return std::vector<double>{1}; });
  slack.sizes = 1;
  slack.open = true;
  truths.push_back(slack);
  Truth adhesion = own_form("adhesion-open", "adhesion", 5, [](double s) {
    return std::vector<double>{s, 3e-4, 0.1};
  });
  adhesion.open = true;
  adhesion.base = {"slack"};
  truths.push_back(adhesion);
  // What one press, and a few, can tell.
  for (const std::string name : {"viscoelastic", "hyperelastic", "tip", "sensor-lag", "damper"})
    for (const int presses : {1, 3}) {
      Truth t = find_truth(truths, name);
      t.name += presses == 1 ? "-one-press" : "-three-presses";
      t.presses = presses;
      truths.push_back(t);
    }
  std::vector<Truth> several = pairs();
  for (Truth& t : triples()) several.push_back(t);
  for (Truth& t : several) {
    for (const std::string& part : t.parts)
      t.effects.push_back(find_truth(truths, part).effects.front());
    truths.push_back(t);
  }
  return truths;
}

const Truth& find_truth(const std::vector<Truth>& truths, const std::string& name) {
  for (const Truth& t : truths)
    if (t.name == name) return t;
  fail_usage("there is no truth " + name, "see truths.cpp");
}

Model true_base(const std::vector<std::string>& base) {
  Model model;
  model.parameters = effect_rows(require_effect("elastic"), 1, {kModulus, kPoisson});
  for (const std::string& effect : base)
    model = with(model, effect,
                 effect == "viscoelastic" ? std::vector<double>{kRelaxing, kRelaxation}
                                          : std::vector<double>{1});
  return model;
}

Eigen::VectorXd forces_of(const Experiment& w, const Model& model) {
  return solved_forces(model, w, all_episodes(w.dataset), false).f;
}

double misfit_of(const Eigen::VectorXd& forces, const Truth& truth, const Experiment& w) {
  const Eigen::VectorXd plain = forces_of(w, true_base(truth.base));
  const double gain = forces.dot(plain) / plain.squaredNorm();
  return std::sqrt((forces - gain * plain).squaredNorm() / static_cast<double>(plain.size()));
}

double largest_misfit(const Truth& truth, const Experiment& w, std::uint64_t seed) {
  Random random(seed);
  return misfit_of(truth.forces(w, true_base(truth.base), truth.most, random), truth, w);
}

double strength_for(const Truth& truth, const Experiment& w, double misfit, std::uint64_t seed) {
  const Model base = true_base(truth.base);
  const auto differs = [&](double s) {
    Random random(seed);
    return misfit_of(truth.forces(w, base, s, random), truth, w);
  };
  double low = 1e-7 * truth.most, high = truth.most;
  double most = differs(high);
  if (most < misfit) return -1;
  // The misfit goes about with the strength; some truths cost finite elements at each.
  constexpr double kClose = 0.03;
  double strength = high;
  for (int k = 0; k < 30; ++k) {
    strength = std::clamp(strength * misfit / most, 1.001 * low, high / 1.001);
    if (k % 3 == 2) strength = std::sqrt(low * high);
    most = differs(strength);
    if (std::abs(most / misfit - 1) < kClose) break;
    (most < misfit ? low : high) = strength;
  }
  return strength;
}

}  // namespace hapsim::bench
