#include "realtime/prepared_body.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "experiment/forces.h"
#include "experiment/labels.h"
#include "experiment/nearest_region.h"
#include "io/stream.h"
#include "simulate/regional_relaxation.h"

namespace hapsim {
namespace {

// A new layout of fields, or another way to sample, gets a new number.
constexpr double kFieldVersion = 6;
// Places where the some thirty materials of regional relaxation are solved.
constexpr std::size_t kRegionalPlaces = 40;
constexpr std::size_t kEntriesAtOnce = 256;

ContactLibraryOptions library_options(const PreparedBodyOptions& options) {
  ContactLibraryOptions library;
  library.threads = options.threads;
  library.cache = options.cache;
  library.rim_edge = options.rim_edge;
  return library;
}

// A contact that feels its own region alone stands on a body of that modulus.
bool is_unit(const MaterialSpec& material) {
  return material.local || material.modulus.size() == 1;
}

// A body's own regions; null where none acts.
struct ActingLabels {
  std::shared_ptr<const BodyRegions> regions;
  std::string key;
};

// Its moduli over the first, or the unit material.
SampledMaterial sampled(const MaterialSpec& material, const ActingLabels& labels) {
  SampledMaterial result;
  result.field.nu = result.solid.nu = material.nu;
  if (is_unit(material)) {
    result.field.modulus = [](const Vec3&) { return 1.0; };
    result.solid.modulus = {1.0};
  } else if (labels.regions) {
    result.solid.modulus.clear();
    for (const double modulus : material.modulus)
      result.solid.modulus.push_back(modulus / material.modulus[0]);
    result.solid.labels = labels.regions;
    result.field.modulus = [solid = result.solid](const Vec3& p) {
      return solid.modulus[solid.group_at(p)];
    };
    result.description = "labels " + labels.key;
  } else {
    result.solid.modulus.clear();
    for (const double modulus : material.modulus)
      result.solid.modulus.push_back(modulus / material.modulus[0]);
    result.field.modulus = [material](const Vec3& p) {
      return material.modulus[static_cast<std::size_t>(region_at(material, p))] /
             material.modulus[0];
    };
    result.solid.group_of = [material](const Vec3& p) { return region_at(material, p); };
    ContentHash regions;
    for (std::size_t k = 0; k < material.key_point.size(); ++k) {
      regions.add(material.key_point[k].x());
      regions.add(material.key_point[k].y());
      regions.add(material.key_region[k]);
    }
    result.description = regions.hex();
  }
  for (const FeatureSpec& f : material.features) result.solid.features.push_back(f.feature);
  return result;
}

double scale_at(const MaterialSpec& material, const Vec3& p) {
  return material.local ? local_modulus(material, p).value : material.modulus[0];
}

// Of all that a field depends on.
std::string key_of(const TetMesh& body, const SampledMaterial& material,
                   const std::vector<KnownStiffness>& known, const PreparedBodyOptions& options) {
  ContentHash key;
  key.add(kFieldVersion);
  std::vector<int> node;
  const Surface surface = boundary_surface(body, &node);
  for (const Vec3& p : surface.vertices) key.add(p.data(), 3 * sizeof(double));
  for (const Triangle& f : surface.faces) key.add(f.data(), sizeof f);
  for (const int n : node) key.add(&body.fixed[static_cast<std::size_t>(n)], 1);
  for (const double value : {options.tool_radius, options.rim_edge, kGrowth, kSampled})
    key.add(value);
  key.add(material.solid.nu);
  for (const double modulus : material.solid.modulus) key.add(modulus);
  for (const BodyFeature& feature : material.solid.features) {
    key.add(static_cast<double>(feature.kind));
    for (const double value : feature.value) key.add(value);
  }
  key.add(material.description);
  for (const KnownStiffness& k : known) {
    key.add(k.point.data(), 3 * sizeof(double));
    key.add(k.K.data(), 9 * sizeof(double));
  }
  key.add(options.tolerance);
  key.add(static_cast<double>(options.most_samples));
  return key.hex();
}

std::unique_ptr<StiffnessField> load_field(const std::string& path) {
  if (path.empty() || !std::filesystem::exists(path)) return nullptr;
  try {
    return std::make_unique<StiffnessField>(Input(path).read_all());
  } catch (const Error&) {
    return nullptr;  // damaged: it is made again
  }
}

void store_field(const std::string& path, const StiffnessField& field) {
  if (path.empty()) return;
  try {
    Output file(path);
    file.write(field.bytes());
    file.commit();
  } catch (const Error&) {
    // A full or read-only cache costs time, not the result.
  }
}

}  // namespace

PreparedBody::PreparedBody(const TetMesh& body, const Model& model,
                           const PreparedBodyOptions& options)
    : effects_(effect_instances(model, false)),
      tool_radius_(options.tool_radius),
      heals_(options.heals) {
  const MaterialSpec material = material_of(model);
  modulus_ = material.modulus[0];
  const bool moved = material.shift != Vec3::Zero() || material.rotation != Vec3::Zero();
  if (moved && !options.contacts)
    fail_input(model.name, "the body has moved, which its own mesh does not know",
               "have the contacts solved finely: hs-simulate --live --contacts data.csv");
  const ModelRelaxation relaxation = relaxation_of(model, material);
  if (options.large_strain && !relaxation.regional.empty())
    fail_input(model.name, "regions that relax each in its own way remember the linear force alone",
               "give all regions the Maxwell elements of region 0, or leave out --large-strain");
  terms_ = relaxation.common;
  ActingLabels labels{acting_labels(material, body), ""};
  if (labels.regions) labels.key = labels_key(body);
  refuse_growth(material, "the live force");
  const SampledMaterial solid = sampled(material, labels);
  std::vector<KnownStiffness> known =
      options.contacts ? options.contacts(material) : std::vector<KnownStiffness>{};
  for (KnownStiffness& k : known) k.K /= scale_at(material, k.point);
  const std::string path =
      options.cache.empty() ? std::string()
                            : options.cache + "/" + key_of(body, solid, known, options) + ".field";
  field_ = load_field(path);
  std::unique_ptr<const FieldSampling> sampling;
  if (!field_ || !relaxation.regional.empty()) {
    const auto library =
        std::make_shared<const ContactLibrary>(body, options.tool_radius, library_options(options));
    std::vector<Vec3> places;
    for (const KnownStiffness& k : known) places.push_back(k.point);
    FieldSamplingOptions how{options.tolerance, options.most_samples, {}};
    if (options.progress) how.sampled = options.progress(options.most_samples);
    sampling = std::make_unique<FieldSampling>(library, options.tool_radius, solid, places, how);
  }
  if (!field_) {
    field_ = std::make_unique<StiffnessField>(boundary_surface(body), *sampling, known,
                                              options.tool_radius, options.threads);
    store_field(path, *field_);
  }
  field_->scale([&](const Vec3& p) { return scale_at(material, p); });
  facts_ = std::make_unique<PlaceFacts>(*field_, material, labels.regions.get(), known);
  if (!relaxation.regional.empty())
    prepare_regional(
        relaxation.regional, material, *sampling,
        [&labels](const MaterialSpec& m) { return sampled(m, labels); }, options);
  if (is_regional() && terms_.size() > static_cast<std::size_t>(kMostTerms))
    fail_input(model.name, "the model has " + std::to_string(terms_.size()) + " relaxation times",
               "the real-time loop takes up to " + std::to_string(kMostTerms));
  distance_ = std::make_unique<SignedDistance>(field_->surface(), "body");
  if (!options.large_strain) return;
  LargeStrainOptions strain;
  strain.tool_radius = tool_radius_;
  strain.tolerance = options.tolerance;
  strain.most_samples = options.most_strain_samples;
  for (const KnownStiffness& k : known) strain.near.push_back(k.point);
  strain.memory = !terms_.empty();
  const auto slips = [](const EffectInstance& i) { return std::isfinite(flat_friction(i)); };
  const auto ball = [](const EffectInstance& i) { return touches_otherwise(i, true); };
  strain.slips = std::any_of(effects_.begin(), effects_.end(), slips) &&
                 std::none_of(effects_.begin(), effects_.end(), ball);
  strain.threads = options.threads;
  strain.cache = options.cache;
  if (options.strain_progress) strain.sampled = options.strain_progress();
  large_strain_ = std::make_unique<LargeStrain>(body, model, *field_, *distance_, *facts_, strain);
}

void PreparedBody::prepare_regional(
    const std::vector<RegionRelaxation>& regions, const MaterialSpec& relaxed,
    const FieldSampling& sampling,
    const std::function<SampledMaterial(const MaterialSpec&)>& sampled,
    const PreparedBodyOptions& options) {
  assert(terms_.empty());  // an effect's terms are common or regional
  const std::vector<FieldEntry>& entries = field_->entries();
  const auto estimate = [&](const MaterialSpec& material) {
    const SampledMaterial solid = sampled(material);
    const std::unique_ptr<PlaceModel> model = sampling.model_of(solid, kRegionalPlaces);
    const PlaceViews views = sampling.views().with(solid.field);
    std::vector<Eigen::Matrix3d> K(entries.size());
    in_parallel((entries.size() + kEntriesAtOnce - 1) / kEntriesAtOnce, options.threads,
                [&](std::size_t block) {
                  std::vector<PlaceView> seen;
                  const std::size_t first = block * kEntriesAtOnce,
                                    last = std::min(first + kEntriesAtOnce, entries.size());
                  for (std::size_t i = first; i < last; ++i)
                    seen.push_back(views.at(entries[i].point));
                  const std::vector<PlaceEstimate> estimates = model->at(seen, false);
                  for (std::size_t i = first; i < last; ++i)
                    K[i] = scale_at(material, entries[i].point) * estimates[i - first].K;
                });
    return K;
  };
  // What the material does is smooth: it is taken from few places, about the field of the relaxed
  // one, K = S K_few S' with S the map that takes the relaxed stiffness of few places to the
  // field's.
  std::vector<Eigen::Matrix3d> S = estimate(relaxed);
  for (std::size_t i = 0; i < S.size(); ++i) {
    const Eigen::Matrix3d few = S[i].llt().matrixL(), all = entries[i].K.llt().matrixL();
    S[i] = all * few.inverse();
  }
  const auto solve = [&](const MaterialSpec& material) {
    std::vector<Eigen::Matrix3d> K = estimate(material);
    for (std::size_t i = 0; i < K.size(); ++i) K[i] = (S[i] * K[i] * S[i].transpose()).eval();
    if (options.contacts) {
      const std::vector<KnownStiffness> known = options.contacts(material);
      for (std::size_t k = 0; k < known.size(); ++k)
        K[static_cast<std::size_t>(field_->known()[k])] = known[k].K;
    }
    return K;
  };
  const std::vector<PositionStiffness> stiffness =
      regional_stiffness(regions, relaxed, solve, misfit_);
  for (const PositionStiffness& s : stiffness)
    for (const MaxwellStiffness& element : s.relaxing) maxwell_.push_back(element.K);
  for (const MaxwellStiffness& element : stiffness.front().relaxing)
    terms_.push_back({1, element.tau});
}

void PreparedBody::maxwell_at(int face, const Vec3& point, Eigen::Matrix3d* K) const noexcept {
  const StiffnessField::Place place = field_->locate(face, point);
  const std::size_t terms = terms_.size();
  for (std::size_t j = 0; j < terms; ++j) {
    K[j].setZero();
    for (int k = 0; k < 3; ++k)
      K[j] += place.weight[k] * maxwell_[static_cast<std::size_t>(place.entry[k]) * terms + j];
  }
}

std::vector<KnownStiffness> known_contacts(const Places& places, const MaterialSpec& material) {
  const Linearisation about = places.solve(material);
  std::vector<KnownStiffness> known;
  for (std::size_t p = 0; p < places.size(); ++p)
    known.push_back({places.contact(p).point, places.contact(p).normal, about.at(p, material).K});
  return known;
}

}  // namespace hapsim
