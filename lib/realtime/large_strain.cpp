#include "realtime/large_strain.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "experiment/labels.h"
#include "io/stream.h"
#include "mesh/way_through.h"
#include "realtime/strain_mesh.h"

namespace hapsim {
namespace {

using Coordinates = Eigen::Matrix<double, 9, 1>;

constexpr double kStrainVersion = 2;  // of samples in the cache
constexpr std::size_t kStrainFirst = 24, kStrainRound = 12, kStrainPool = 600;
// The first where much may be left unknown, and the tolerance from which on that is so.
constexpr std::size_t kStrainFewest = 8;
constexpr double kStrainMuch = 0.1;
constexpr double kStrainThrough = 0.35;  // of the way through the body
constexpr double kStrainApart = 0.5;     // samples, in tool radii
// Lengths by which first places are told apart: tool radii, of a normal, of logarithms of K.
constexpr std::array<double, 3> kUnlike{3, 0.3, 0.15};

template <class Stored>
std::optional<Stored> load(const std::string& path) {
  if (path.empty() || !std::filesystem::exists(path)) return std::nullopt;
  try {
    return Stored::read(Input(path).read_all());
  } catch (const Error&) {
    return std::nullopt;
  }
}

template <class Stored>
void store(const std::string& path, const Stored& sample) {
  if (path.empty()) return;
  try {
    Output file(path);
    file.write(sample.bytes());
    file.commit();
  } catch (const Error&) {
    // A full or read-only cache costs time, not the result.
  }
}

}  // namespace

bool is_finite_strain(const EffectInstance& effect) {
  FullSpec spec;
  return effect.effect->full(effect.values, 1, spec) && spec.finite;
}

bool touches_otherwise(const EffectInstance& effect, bool slips) {
  FullSpec spec;
  return effect.effect->full(effect.values, 1, spec) &&
         ((std::isfinite(spec.friction) && !slips) || spec.curvature != 0);
}

double flat_friction(const EffectInstance& effect) {
  FullSpec spec;
  const bool flat = effect.effect->full(effect.values, 1, spec) && spec.curvature == 0;
  return flat ? spec.friction : std::numeric_limits<double>::infinity();
}

Model static_part(const Model& model, bool slips) {
  std::set<std::string> kept;
  bool finite = false;
  for (const EffectInstance& i : effect_instances(model, false)) {
    const EffectCard& card = i.effect->card();
    const bool holds = card.stage == Stage::kBody || card.stage == Stage::kSupport;
    if (!holds && !(slips && std::isfinite(flat_friction(i)))) continue;
    FullSpec spec;
    if (!i.effect->full(i.values, 1, spec) || !spec.terms.empty()) continue;
    kept.insert(card.name);
    finite = finite || is_finite_strain(i);
  }
  if (!finite)
    fail_input(model.name, "the model has no finite strain, so there is nothing to sample of it",
               "give it the effect hyperelastic with finite = 1, or leave out --large-strain");
  Model result;
  result.name = model.name;
  for (const Parameter& p : model.parameters)
    if (kept.count(p.effect) > 0) result.parameters.push_back(p);
  return result;
}

LargeStrain::LargeStrain(const TetMesh& body, const Model& model, const StiffnessField& field,
                         const SignedDistance& surface, const PlaceFacts& facts,
                         const LargeStrainOptions& options)
    : body_(body),
      model_(static_part(model)),
      field_(field),
      surface_(surface),
      facts_(facts),
      options_(options),
      base_(make_contact_base(body)) {
  options_.most_samples = std::min<std::size_t>(options_.most_samples, kMostSamples);
  ContentHash key;
  key.add(kStrainVersion);
  std::vector<int> node;
  const Surface boundary = boundary_surface(body, &node);
  for (const Vec3& p : boundary.vertices) key.add(p.data(), 3 * sizeof(double));
  for (const Triangle& f : boundary.faces) key.add(f.data(), sizeof f);
  for (const int n : node) key.add(&body.fixed[static_cast<std::size_t>(n)], 1);
  for (const Parameter& p : model_.parameters) {
    key.add(p.effect + '/' + p.name);
    key.add(p.region);
    key.add(p.value);
  }
  if (acting_labels(material_of(model_), body)) key.add("labels " + labels_key(body));
  key.add(options_.tool_radius);
  key_ = key.hex();

  const std::size_t first = std::min(
      options_.tolerance < kStrainMuch ? kStrainFirst : kStrainFewest, options_.most_samples);
  add(apart(draw(kStrainPool, 1), first));
  if (samples_.size() < std::min<std::size_t>(first, 8))
    fail_input(model.name,
               "hardly any place of this body could be solved at finite strain" +
                   (refused_.empty() ? "" : "; the last: " + refused_),
               "check the unit of the tool's radius, or leave out --large-strain");
  const auto compared = [](const Known& known) { return known.sample.finer.has_value(); };
  if (std::none_of(samples_.begin(), samples_.end(), compared))  // those places were refused
    samples_[0].sample.finer =
        strain_mesh_error(body_, base_, model_, samples_[0].sample, options_.tool_radius);
  for (std::uint64_t round = 2;; ++round) {
    relate();
    if (left_out_ <= options_.tolerance || tried_.size() >= options_.most_samples) break;
    const std::size_t count = std::min(kStrainRound, options_.most_samples - tried_.size());
    const std::vector<StepPlace> next = apart(draw(kStrainPool, round), count);
    if (next.empty()) break;
    add(next);
  }
  if (options_.slips) add_slip(static_part(model, true));
}

// Friction at the first places.
void LargeStrain::add_slip(const Model& model) {
  const bool finer = options_.tolerance < kStrainMuch;
  const std::size_t wanted = finer ? 2 : 1;
  double friction = std::numeric_limits<double>::infinity();
  for (const EffectInstance& i : effect_instances(model, false))
    friction = std::min(friction, flat_friction(i));
  std::vector<std::optional<SlipPresses>> found(std::min(wanted, samples_.size()));
  in_parallel(found.size(), options_.threads, [&](std::size_t i) {
    const StrainSample& sample = samples_[i].sample;
    ContentHash key;
    key.add(key_);
    key.add(sample.point.data(), 3 * sizeof(double));
    key.add(sample.into);
    key.add(friction);
    key.add(finer ? 1.0 : 0.0);
    const std::string path =
        options_.cache.empty() ? "" : options_.cache + "/" + key.hex() + ".slip";
    found[i] = load<SlipPresses>(path);
    if (!found[i]) {
      found[i] = press_slipping(body_, base_, model_, model, sample, options_.tool_radius, friction,
                                1 + i, finer);
      if (found[i]) store(path, *found[i]);
    }
    if (options_.sampled) options_.sampled();
  });
  std::vector<SlipPlace> places;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i]) places.push_back({samples_[i].sample, *found[i]});
  if (!places.empty()) slip_ = fit_strain_slip(places, options_.threads);
}

// Uniform over the surface where the tool can be laid on.
std::vector<StepPlace> LargeStrain::draw(std::size_t count, std::uint64_t seed) const {
  const Surface& s = surface_.surface();
  std::vector<double> up_to;
  for (std::size_t f = 0; f < s.faces.size(); ++f)
    up_to.push_back((f > 0 ? up_to.back() : 0) + face_normal(s, static_cast<int>(f)).norm());
  Random random(seed);
  std::vector<StepPlace> places;
  for (std::size_t tries = 0; places.size() < count && tries < 200 * count; ++tries) {
    const auto f =
        std::min(s.faces.size() - 1,
                 static_cast<std::size_t>(
                     std::lower_bound(up_to.begin(), up_to.end(), random.uniform() * up_to.back()) -
                     up_to.begin()));
    const Triangle& t = s.faces[f];
    const double a = std::sqrt(random.uniform()), b = random.uniform();
    const Vec3 p =
        (1 - a) * s.vertices[t[0]] + a * (1 - b) * s.vertices[t[1]] + a * b * s.vertices[t[2]];
    const double reach = kNear * options_.tool_radius;
    if (!options_.near.empty() &&
        std::none_of(options_.near.begin(), options_.near.end(),
                     [&](const Vec3& n) { return (n - p).norm() <= reach; }))
      continue;
    const SurfaceSide side = surface_.at(p);
    if (!field_.entry_at(field_.locate(side.face, side.point)).sampled) continue;
    places.push_back(facts_.at(side.face, side.point, side.normal));
  }
  return places;
}

// Of the pool those farthest from what is solved and from each other: by the process's doubt once
// there is one, else by place, normal and stiffness alike.
std::vector<StepPlace> LargeStrain::apart(const std::vector<StepPlace>& pool,
                                          std::size_t count) const {
  const auto distance = [this](const Coordinates& a, const Coordinates& b) {
    if (variance_ > 0) return 1 - covariance(a, b);
    double sum = 0;
    for (int g = 0; g < 3; ++g)
      sum += (a - b).segment<3>(3 * g).squaredNorm() / std::pow(kUnlike[g], 2);
    return sum;
  };
  std::vector<Coordinates> at;
  for (const StepPlace& p : pool) at.push_back(coordinates(p));
  std::vector<double> nearest(pool.size(), std::numeric_limits<double>::max());
  for (std::size_t i = 0; i < pool.size(); ++i) {
    for (const Known& k : samples_) nearest[i] = std::min(nearest[i], distance(at[i], k.at));
    for (const Vec3& p : tried_)
      if ((p - pool[i].point).norm() < kStrainApart * options_.tool_radius) nearest[i] = 0;
  }
  std::vector<StepPlace> chosen;
  while (chosen.size() < count && !pool.empty()) {
    const auto best = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) -
                                               nearest.begin());
    if (!(nearest[best] > 0)) break;
    chosen.push_back(pool[best]);
    for (std::size_t i = 0; i < pool.size(); ++i)
      nearest[i] = std::min(nearest[i], distance(at[i], at[best]));
    nearest[best] = 0;
  }
  return chosen;
}

void LargeStrain::add(std::vector<StepPlace> places) {
  constexpr std::size_t kCompared = 2;  // samples with finer elements beside
  std::vector<std::optional<StrainSample>> found(places.size());
  std::vector<std::string> why(places.size());
  in_parallel(places.size(), options_.threads, [&](std::size_t i) {
    const StepPlace& place = places[i];
    ContentHash key;
    key.add(key_);
    key.add(place.point.data(), 3 * sizeof(double));
    const std::string path =
        options_.cache.empty() ? "" : options_.cache + "/" + key.hex() + ".strain";
    found[i] = load<StrainSample>(path);
    const bool compared = samples_.empty() && i < kCompared;
    if (found[i] && options_.memory && !found[i]->memory) found[i].reset();
    if (found[i] && compared && !found[i]->finer) found[i].reset();
    if (!found[i]) {
      const double through = way_through(surface_, place.point, -place.normal);
      const double into = std::min(kDeepest, kStrainThrough * through / options_.tool_radius);
      found[i] = solve_strain_sample(body_, base_, model_, place.point, options_.tool_radius, into,
                                     options_.memory, why[i]);
      if (found[i] && compared)
        found[i]->finer = strain_mesh_error(body_, base_, model_, *found[i], options_.tool_radius);
      if (found[i]) store(path, *found[i]);
    }
    if (options_.sampled) options_.sampled();
  });
  for (std::size_t i = 0; i < places.size(); ++i) {
    tried_.push_back(places[i].point);
    if (!why[i].empty()) refused_ = why[i];
    if (found[i]) samples_.push_back({*found[i], coordinates(places[i]), places[i].normal});
  }
}

}  // namespace hapsim
