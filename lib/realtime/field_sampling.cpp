#include "realtime/field_sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "mesh/between_plates.h"
#include "realtime/direction_doubt.h"

namespace hapsim {
namespace {

constexpr std::size_t kFirst = 64;   // samples before there is a model,
constexpr std::size_t kFewest = 24;  // and where much may be left unknown:
constexpr double kMuch = 0.1;        // the tolerance from which on that is so
constexpr std::size_t kPool = 1200;  // places among which the next are chosen
// One place of so many is solved on the finer mesh too: of the first ones, and of later ones.
constexpr std::size_t kFirstBoth = 5, kBoth = 12;
// So near to what is bonded, in tool radii, the meshes differ by more than a common factor.
constexpr double kBesideSupport = 2.5;
// Meshes are made from one radius on, but not of every place up to here.
constexpr double kClear = 1.2;
// Where the surface about turns so much, two radii from a right-angled edge, coarse meshes scatter.
constexpr double kBesideEdge = 0.03;
// What yields as a whole by more than its contact does: coarse meshes of limbs scatter, too.
constexpr double kLimb = 2;
// And where the body hardly changes its volume: by 1 to 8 % about a scanned bunny at 0.499.
constexpr double kHardlyCompressible = 0.485;
// A place that was refused says little of those beyond that share of a radius, which are tried.
constexpr double kNearRefused = 0.3;
// The share of the pool that may be less sure than this, in tolerances: twice that is the worst.
constexpr double kTail = 0.01, kLeastSure = 1.25;

double clearance(const SurfaceTree& bonded, const Vec3& p) {
  return bonded.surface().faces.empty() ? std::numeric_limits<double>::infinity()
                                        : bonded.nearest(p).distance;
}

// As many of the places as far from each other as can be, greedily.
std::vector<Vec3> spread(const std::vector<Vec3>& places, std::size_t count) {
  std::vector<double> distance(places.size(), std::numeric_limits<double>::infinity());
  std::vector<Vec3> chosen;
  for (std::size_t next = 0; chosen.size() < std::min(count, places.size());) {
    chosen.push_back(places[next]);
    for (std::size_t i = 0; i < places.size(); ++i)
      distance[i] = std::min(distance[i], (places[i] - places[next]).norm());
    next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) -
                                    distance.begin());
  }
  return chosen;
}

// None where the coarse surface cannot be meshed, or it costs more than the few samples that are
// asked for: they alone tell then.
std::shared_ptr<const FarCompliance> far_compliance(const ContactBase& base, double tool_radius,
                                                    const Material& material, int threads,
                                                    const FieldSamplingOptions& options) {
  if (options.tolerance >= kMuch || options.most < kFirst) return nullptr;
  try {
    return std::make_shared<FarCompliance>(base, tool_radius, material, threads);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    return nullptr;
  }
}

Eigen::Vector2d along_and_across(const Eigen::Matrix3d& K, const Vec3& n) {
  const double along = n.dot(K * n);
  return {std::log(along), std::log((K.trace() - along) / 2)};
}

}  // namespace

FieldSampling::FieldSampling(std::shared_ptr<const ContactLibrary> library, double tool_radius,
                             SampledMaterial material, const std::vector<Vec3>& known,
                             const FieldSamplingOptions& options)
    : library_(std::move(library)),
      radius_(tool_radius),
      material_(std::move(material)),
      options_(options) {
  const Surface& surface = library_->surface();
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.vertices) box.extend(p);
  if (height_between_plates(surface, box.center(), Vec3::UnitZ(), radius_) > 0)
    fail_input("", "the tool covers the whole body, which is compressed between plates",
               "simulate it without a live loop");
  Surface held;
  held.vertices = surface.vertices;
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
    if (library_->bonded()[f]) held.faces.push_back(surface.faces[f]);
  bonded_ = std::make_unique<SurfaceTree>(std::move(held));
  views_ =
      std::make_unique<PlaceViews>(surface, library_->bonded(), tool_radius, material_.field,
                                   far_compliance(library_->base(), tool_radius, material_.solid,
                                                  library_->threads(), options_));
  std::vector<Vec3> first = known;
  const std::size_t begin = std::min(options_.tolerance < kMuch ? kFirst : kFewest, options_.most);
  for (const Vec3& p : spread(draw(20 * kFirst, 1), begin)) first.push_back(p);
  add(first);
  if (samples_.size() < begin / 4)
    fail_input("", "the tool can be laid on hardly any place of this body",
               "check the unit of the tool's radius, or bond less of the body");
  bool confirmed = options_.tolerance >= kMuch;
  for (std::uint64_t round = 2;; ++round) {
    fit();
    const std::vector<Vec3> pool = draw(kPool, round);
    const std::vector<PlaceView> views = views_of(pool);
    std::vector<double> squares;
    for (const PlaceEstimate& e : model_->at(views, true))
      squares.push_back(std::pow(e.uncertainty * mean_direction_doubt(e.K), 2));
    double sum = 0;
    for (const double s : squares) sum += s;
    expected_ = std::sqrt(sum / static_cast<double>(squares.size()));
    const auto tail =
        squares.end() - 1 - static_cast<std::ptrdiff_t>(kTail * static_cast<double>(kPool));
    std::nth_element(squares.begin(), tail, squares.end());
    const bool reached =
        expected_ <= options_.tolerance && std::sqrt(*tail) <= kLeastSure * options_.tolerance;
    // Few samples may agree by chance, all far from a corner: those where least is known must, too.
    if ((reached && confirmed) || tried() >= options_.most) break;
    confirmed = confirmed || reached;
    const std::size_t count =
        std::min(options_.most - tried(), std::max<std::size_t>(32, samples_.size() / 3));
    std::vector<Vec3> next;
    for (const std::size_t i : model_->most_wanted(views, count)) next.push_back(pool[i]);
    add(next);
  }
}

// Uniform over the touchable surface.
std::vector<Vec3> FieldSampling::draw(std::size_t count, std::uint64_t seed) const {
  const Surface& surface = library_->surface();
  std::vector<double> up_to;
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
    up_to.push_back((f > 0 ? up_to.back() : 0) +
                    (library_->bonded()[f] ? 0 : face_normal(surface, static_cast<int>(f)).norm()));
  Random random(seed);
  std::vector<Vec3> places;
  for (std::size_t tries = 0; places.size() < count && tries < 50 * count; ++tries) {
    const double at = random.uniform() * up_to.back();
    const auto f = static_cast<std::size_t>(std::upper_bound(up_to.begin(), up_to.end() - 1, at) -
                                            up_to.begin());
    const Triangle& t = surface.faces[f];
    const double a = std::sqrt(random.uniform()), b = random.uniform();
    const Vec3 p = (1 - a) * surface.vertices[t[0]] + a * (1 - b) * surface.vertices[t[1]] +
                   a * b * surface.vertices[t[2]];
    if (is_touchable(p, kNearRefused * radius_)) places.push_back(p);
  }
  if (places.empty())
    fail_input("", "the tool can be laid on no place of this body",
               "check the unit of the tool's radius, or bond less of the body");
  return places;
}

bool FieldSampling::is_touchable(const Vec3& point) const {
  return clearance(*bonded_, point) >= kClear * radius_ && is_touchable(point, radius_);
}

bool FieldSampling::is_touchable(const Vec3& point, double reach) const {
  if (clearance(*bonded_, point) < radius_) return false;
  double refused = std::numeric_limits<double>::infinity(), taken = refused;
  for (const Vec3& p : refused_) refused = std::min(refused, (p - point).squaredNorm());
  if (refused > reach * reach) return true;
  for (const Vec3& p : places_) taken = std::min(taken, (p - point).squaredNorm());
  return taken < refused;
}

std::vector<PlaceView> FieldSampling::views_of(const std::vector<Vec3>& places) const {
  std::vector<PlaceView> views(places.size());
  in_parallel(places.size(), library_->threads(),
              [&](std::size_t i) { views[i] = views_->at(places[i]); });
  return views;
}

ContactLevel FieldSampling::level_at(const PlaceView& view) const {
  if (clearance(*bonded_, view.point) < kBesideSupport * radius_) return ContactLevel::kFine;
  const bool scatters =
      view.turned > kBesideEdge || view.yields > kLimb || material_.solid.nu > kHardlyCompressible;
  return scatters ? ContactLevel::kCoarse : ContactLevel::kSample;
}

void FieldSampling::add(const std::vector<Vec3>& places) {
  const std::vector<PlaceView> views = views_of(places);
  const std::size_t every = samples_.empty() ? kFirstBoth : kBoth;
  const auto solve = [&](const std::vector<std::size_t>& which, ContactLevel level) {
    std::vector<Vec3> where;
    for (const std::size_t i : which) where.push_back(places[i]);
    return library_->sample(where, material_.solid, material_.description, level, false);
  };
  for (const ContactLevel level :
       {ContactLevel::kFine, ContactLevel::kCoarse, ContactLevel::kSample}) {
    std::vector<std::size_t> which, both;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (level_at(views[i]) == level) which.push_back(i);
    const auto found = solve(which, level);
    for (std::size_t k = 0; k < which.size(); ++k) {
      const std::size_t i = which[k];
      if (options_.sampled) options_.sampled();
      if (!found[k]) {
        refused_.push_back(places[i]);
        continue;
      }
      places_.push_back(places[i]);
      samples_.push_back({views[i], found[k]->K});
      levels_.push_back(level);
    }
    if (level == ContactLevel::kFine) continue;
    for (std::size_t k = 0; k < which.size(); k += every)
      if (found[k]) both.push_back(k);
    std::vector<std::size_t> again;
    for (const std::size_t k : both) again.push_back(which[k]);
    const auto fine = solve(again, ContactLevel::kFine);
    for (std::size_t j = 0; j < both.size(); ++j)
      if (fine[j])
        ratio_[static_cast<std::size_t>(level)].found.push_back(
            along_and_across(fine[j]->K, fine[j]->normal) -
            along_and_across(found[both[j]]->K, fine[j]->normal));
  }
}

Eigen::Matrix3d FieldSampling::corrected(const Eigen::Matrix3d& K, const Vec3& normal,
                                         ContactLevel level) const {
  const Eigen::Vector2d& finer = ratio_[static_cast<std::size_t>(level)].mean;
  const double along = std::exp(finer[0] / 2), across = std::exp(finer[1] / 2);
  const Eigen::Matrix3d n = normal * normal.transpose();
  const Eigen::Matrix3d S = along * n + across * (Eigen::Matrix3d::Identity() - n);
  return S * K * S;
}

void FieldSampling::fit() {
  double squares = 0, count = 0;
  for (Ratio& ratio : ratio_) {
    const auto n = static_cast<double>(ratio.found.size());
    ratio.mean.setZero();
    for (const Eigen::Vector2d& r : ratio.found) ratio.mean += r / n;
    for (const Eigen::Vector2d& r : ratio.found) squares += (r - ratio.mean).squaredNorm() / 2;
    count += std::max(n - 1, 0.0);
  }
  if (count > 0) noise_ = std::sqrt(squares / count);
  std::vector<StiffnessSample> samples = samples_;
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].K = corrected(samples[i].K, samples[i].view.normal, levels_[i]);
  model_ = std::make_unique<PlaceModel>(samples, noise_);
}

std::unique_ptr<PlaceModel> FieldSampling::model_of(const SampledMaterial& material,
                                                    std::size_t most) const {
  const std::vector<Vec3> places = spread(places_, most);
  const auto coarse =
      library_->sample(places, material.solid, material.description, ContactLevel::kSample, true);
  const PlaceViews views = views_->with(material.field);
  std::vector<StiffnessSample> samples;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (coarse[i]) {
      StiffnessSample s{views.at(places[i]), coarse[i]->K};
      s.K = corrected(s.K, s.view.normal, ContactLevel::kSample);
      samples.push_back(std::move(s));
    }
  return std::make_unique<PlaceModel>(samples, noise_, model_.get());
}

}  // namespace hapsim
