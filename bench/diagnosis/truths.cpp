#include "truths.h"

#include <algorithm>
#include <cmath>

#include "effects/catalogue.h"
#include "model/extend.h"

namespace hapsim::bench {
namespace {

constexpr double kModulus = 1.5e4, kPoisson = 0.42;   // [Pa], 1
constexpr double kRelaxing = 4e3, kRelaxation = 0.6;  // [Pa], [s]

using Strengths = std::function<std::vector<double>(double)>;
using Change =
    std::function<void(const Episode&, double strength, Random&, Eigen::Ref<Eigen::VectorXd>)>;

Eigen::VectorXd forces_of(const Workspace& w, const Model& model) {
  w.body->solve(material_of(model));  // exact, not linear about an earlier strength
  return model_forces(model, w.dataset, all_episodes(w.dataset), *w.body, false).f;
}

Model with(Model model, const std::string& effect, const std::vector<double>& values) {
  const Effect& e = require_effect(effect);
  const int terms = static_cast<int>(values.size() / e.card().parameters.size());
  for (const Parameter& p : effect_rows(e, terms, values)) model.parameters.push_back(p);
  return model;
}

// The effect in the catalogue's own form, values by strength.
Truth own_form(const std::string& name, const std::string& effect, double most,
               const Strengths& values) {
  Truth truth{name, effect, false, most, {}, {}};
  truth.forces = [effect, values](const Workspace& w, const Model& base, double s, Random&) {
    return forces_of(w, s > 0 && !effect.empty() ? with(base, effect, values(s)) : base);
  };
  return truth;
}

// A change of the base's forces, press by press, in a form that the catalogue does not have.
Truth other_form(const std::string& name, const std::string& effect, double most,
                 const Change& change) {
  Truth truth{name, effect, false, most, {}, {}};
  truth.forces = [change](const Workspace& w, const Model& base, double s, Random& random) {
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
  Truth truth{name, "regions", false, 3, {}, {}};
  truth.forces = [factor](const Workspace& w, const Model& base, double s, Random&) {
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

// One half of the body stiffer than the other.
Truth halves() {
  Truth truth{"regions", "regions", false, 3, {}, {}};
  truth.forces = [](const Workspace& w, const Model& base, double s, Random&) {
    Model model = base;
    if (s > 0) {
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
    }
    return forces_of(w, model);
  };
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
  t.push_back(own_form("damper", "damper", 100, [](double s) { return std::vector<double>{s}; }));
  t.push_back(own_form("hyperelastic", "hyperelastic", 1.2, [](double s) {
    return std::vector<double>{s, std::min(1.0, 5 * s)};
  }));
  t.push_back(own_form("tip", "tip", 250, [](double s) { return std::vector<double>{s}; }));
  t.push_back(own_form("layer", "layer", 20, [](double s) {
    return std::vector<double>{2e-3, 1 + s};
  }));
  t.push_back(own_form("anisotropic", "anisotropic", 4, [](double s) {
    return std::vector<double>{1 + s, 1, 1.4, 0.3};
  }));
  t.push_back(own_form("base", "base", 1, [](double s) { return std::vector<double>{s, 0.5, 0}; }));
  t.push_back(own_form("temperature", "temperature", 0.5, [](double s) {
    return std::vector<double>{s, 25};
  }));
  t.push_back(own_form("softening", "softening", 0.9, [](double s) {
    return std::vector<double>{s, 3, 1};
  }));
  t.push_back(
      own_form("backlash", "backlash", 3e-3, [](double s) { return std::vector<double>{s}; }));
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
  t.push_back(own_form("sensor-curve", "sensor-curve", 1, [](double s) {
    return std::vector<double>{-s, 0, -s, 0};
  }));
  t.push_back(
      own_form("sensor-lag", "sensor-lag", 1, [](double s) { return std::vector<double>{s}; }));
  t.push_back(own_form("sensor-bias", "sensor-bias", 5, [](double s) {
    return std::vector<double>{s, -0.5 * s, s};
  }));
  t.push_back(own_form("sensor-drift", "sensor-drift", 0.1, [](double s) {
    return std::vector<double>{0, 0, 0, 0.3 * s, -0.5 * s, s};
  }));
  t.push_back(own_form("deadband-short", "deadband", 0.25, [](double s) {
    return std::vector<double>{s, 1};
  }));
  t.push_back(own_form("deadband-true", "deadband", 0.25, [](double s) {
    return std::vector<double>{s, 0};
  }));
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
                           const Values tau{{0, "tau", std::max(s, 1e-9), -1}};
                           const Effect& lag = require_effect("sensor-lag");
                           lag.apply(e.view, tau, signal);
                           lag.apply(e.view, tau, signal);
                           f = signal.f;
                         }));
  return t;
}

}  // namespace

std::vector<Truth> all_truths() {
  std::vector<Truth> truths = own_forms();
  for (Truth& t : other_forms()) truths.push_back(std::move(t));
  Truth nothing = own_form("nothing", "", 0, [](double) { return std::vector<double>(); });
  truths.insert(truths.begin(), nothing);
  // The same on a body that relaxes, which the diagnosed model knows.
  const std::size_t count = truths.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (truths[k].effect == "viscoelastic") continue;
    Truth t = truths[k];
    t.name += "+relaxing";
    t.base = {"viscoelastic"};
    truths.push_back(t);
  }
  // Air samples that nobody marked: the body cannot pull there.
  Truth slack = own_form("slack", "slack", 1, [](double) { return std::vector<double>{1}; });
  slack.open = true;
  truths.push_back(slack);
  Truth adhesion = own_form("adhesion-open", "adhesion", 5, [](double s) {
    return std::vector<double>{s, 3e-4, 0.1};
  });
  adhesion.open = true;
  adhesion.base = {"slack"};
  truths.push_back(adhesion);
  Truth open = nothing;
  open.name = "nothing-open";
  open.open = true;
  open.base = {"slack"};
  truths.push_back(open);
  return truths;
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

double strength_for(const Truth& truth, const Workspace& w, double misfit, std::uint64_t seed) {
  const Model base = true_base(truth.base);
  const Eigen::VectorXd plain = forces_of(w, base);
  const auto differs = [&](double s) {
    Random random(seed);
    const Eigen::VectorXd f = truth.forces(w, base, s, random);
    const double gain = f.dot(plain) / plain.squaredNorm();
    return std::sqrt((f - gain * plain).squaredNorm() / static_cast<double>(f.size()));
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
