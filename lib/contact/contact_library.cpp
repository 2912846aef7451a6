#include "contact/contact_library.h"

#include <algorithm>
#include <cmath>

#include "base/blas.h"
#include "base/error.h"
#include "base/parallel.h"
#include "tetmesh/contact_unfit.h"

namespace hapsim {
namespace {

// x = (1 - 2 nu)^(1/3) and its derivative by nu.
double coordinate(double nu) {
  return std::cbrt(1 - 2 * nu);
}
double coordinate_slope(double nu) {
  return -2.0 / 3 / std::pow(coordinate(nu), 2);
}

// What features do hardly depends on it; estimates are made for soft tissue.
constexpr double kTypicalPoisson = 0.42;

}  // namespace

void UnitStiffness::add(double nu, const Eigen::Matrix3d& K, const Eigen::Matrix3d& dK_dnu) {
  nodes_.push_back({nu, K, dK_dnu});
}

void UnitStiffness::evaluate(double nu, Eigen::Matrix3d& K, Eigen::Matrix3d& dK_dnu) const {
  // Newton's divided differences with every node doubled; g = K / mu = 2 (1 + nu) K for E = 1.
  const std::size_t n = 2 * nodes_.size();
  std::vector<double> x(n);
  std::vector<Eigen::Matrix3d> c(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Node& node = nodes_[i / 2];
    x[i] = coordinate(node.nu);
    c[i] = 2 * (1 + node.nu) * node.K;
  }
  for (std::size_t order = 1; order < n; ++order)
    for (std::size_t i = n - 1; i >= order; --i) {
      if (x[i] == x[i - order]) {
        const Node& node = nodes_[i / 2];
        c[i] = (2 * node.K + 2 * (1 + node.nu) * node.dK_dnu) / coordinate_slope(node.nu);
      } else {
        c[i] = (c[i] - c[i - 1]) / (x[i] - x[i - order]);
      }
    }
  const double at = coordinate(nu);
  Eigen::Matrix3d g = c[n - 1], dg = Eigen::Matrix3d::Zero();
  for (std::size_t i = n - 1; i-- > 0;) {
    dg = dg * (at - x[i]) + g;
    g = g * (at - x[i]) + c[i];
  }
  K = g / (2 * (1 + nu));
  dK_dnu = (coordinate_slope(nu) * dg - 2 * K) / (2 * (1 + nu));
}

std::vector<double> poisson_nodes(double nu_low, double nu_high) {
  if (!(nu_high > nu_low)) return {nu_low};
  // Chebyshev points of the coordinate over the range: three doubled nodes, a quintic.
  const double a = coordinate(nu_high), b = coordinate(nu_low);
  std::vector<double> nus;
  for (const double x : {-0.8660254037844387, 0.0, 0.8660254037844387})
    nus.push_back((1 - std::pow(0.5 * (a + b) + 0.5 * (b - a) * x, 3)) / 2);
  return nus;
}

std::string labels_key(const TetMesh& body) {
  ContentHash hash;
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    hash.add(body.region.empty() ? 0.0 : static_cast<double>(body.region[t]));
    for (std::size_t k = 0; k < 4; ++k)
      hash.add(body.nodes[static_cast<std::size_t>(body.tets[t][k])].data(), 3 * sizeof(double));
  }
  return hash.hex();
}

ContactLibrary::ContactLibrary(const TetMesh& body, double tool_radius,
                               const ContactLibraryOptions& options)
    : boundary_(body_boundary(body)),
      labels_(BodyRegions::of(body)),
      labels_key_(labels_ ? hapsim::labels_key(body) : ""),
      inner_(labels_ ? std::make_shared<const std::vector<Surface>>(labels_->enclosed()) : nullptr),
      radius_(tool_radius),
      options_(options),
      cache_(options.cache) {
  // Meshing forks; OpenBLAS must have its one thread before that.
  prepare_blas_for_many_threads();
  for (const Vec3& p : boundary_.surface.vertices) base_hash_.add(p.data(), sizeof(double) * 3);
  for (const Triangle& f : boundary_.surface.faces) base_hash_.add(f.data(), sizeof f);
  base_hash_.add(boundary_.face_class.data(), boundary_.face_class.size());
  base_hash_.add(radius_);
  base_hash_.add(options.rim_edge);
  base_hash_.add(kGrowth);
  base_hash_.add(kCoarser);
  content_ = base_hash_;
  content_.add(options.draft ? 1.0 : 0.0);
}

const ContactBase& ContactLibrary::base() const {
  return base_.get([&] { return make_contact_base(boundary_); });
}

std::string ContactLibrary::bodies_key(const Vec3& position) const {
  ContentHash hash = base_hash_;
  hash.add(position.data(), sizeof(double) * 3);
  return hash.hex();
}

std::shared_ptr<ContactBodies> ContactLibrary::fresh_bodies(const Vec3& p) const {
  const auto& surface = free_surface_.get([&] { return free_surface(base()); });
  return std::make_shared<ContactBodies>(base(), p, radius_, options_.rim_edge, surface, inner_);
}

std::shared_ptr<ContactBodies> ContactLibrary::take_bodies(const Vec3& position) const {
  auto kept = memo().take<ContactBodies>(bodies_key(position));
  return kept ? kept : fresh_bodies(position);
}

void ContactLibrary::put_bodies(const Vec3& position, std::shared_ptr<ContactBodies> bodies) const {
  memo().put(bodies_key(position), std::move(bodies));
}

ContentHash ContactLibrary::key_of(const Material& material, const std::string& description) const {
  ContentHash hash = base_hash_;
  hash.add(material.nu);
  for (const double modulus : material.modulus) hash.add(modulus);
  for (const BodyFeature& feature : material.features) {
    hash.add(static_cast<double>(feature.kind));
    for (const double value : feature.value) hash.add(value);
  }
  hash.add(description);
  return hash;
}

std::vector<StiffnessSolution> ContactLibrary::solve_all(const std::vector<Vec3>& positions,
                                                         const std::vector<Task>& tasks,
                                                         bool keep) const {
  const std::size_t m = tasks.size();
  std::vector<StiffnessSolution> results(positions.size() * m);
  in_parallel(positions.size(), options_.threads, [&](std::size_t p) {
    std::shared_ptr<ContactBodies> bodies;
    for (std::size_t k = 0; k < m; ++k) {
      ContentHash hash = tasks[k].key;
      hash.add(positions[p].data(), sizeof(double) * 3);
      if (auto found = cache_.load(hash.hex())) {
        results[p * m + k] = *found;
        continue;
      }
      if (!bodies) bodies = keep ? take_bodies(positions[p]) : fresh_bodies(positions[p]);
      try {
        results[p * m + k] = tasks[k].solve(*bodies, p);
      } catch (const ContactUnfit& error) {
        results[p * m + k].unfit = error.what();
        bodies = nullptr;
        break;
      }
      cache_.store(hash.hex(), results[p * m + k]);
    }
    if (bodies && keep) put_bodies(positions[p], std::move(bodies));
    if (options_.step) options_.step();
  });
  return results;
}

std::vector<std::optional<SampledContact>> ContactLibrary::sample(const std::vector<Vec3>& places,
                                                                  const Material& material,
                                                                  const std::string& description,
                                                                  ContactLevel level,
                                                                  bool keep) const {
  ContentHash common = key_of(material, "sample " + description);
  common.add(level == ContactLevel::kFine     ? 1
             : level == ContactLevel::kCoarse ? kCoarser
                                              : kSampled);
  std::vector<std::optional<SampledContact>> results(places.size());
  in_parallel(places.size(), options_.threads, [&](std::size_t p) {
    ContentHash hash = common;
    hash.add(places[p].data(), sizeof(double) * 3);
    if (const auto found = cache_.load(hash.hex())) {
      results[p] = {found->point, found->normal, found->K};
    } else {
      const std::shared_ptr<ContactBodies> bodies =
          keep ? take_bodies(places[p]) : fresh_bodies(places[p]);
      try {
        results[p] = bodies->sample(material, level);
      } catch (const Error& error) {
        // Flat tetrahedra near nu = 1/2 may leave a matrix that is not definite in numbers: of this
        // place nothing is known then, as where it cannot be meshed.
        if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kNoConvergence) throw;
      }
      if (results[p]) {
        StiffnessSolution entry{};
        entry.K = results[p]->K;
        entry.dK_dnu = entry.coarse_change = entry.coarse_dK_dnu = Eigen::Matrix3d::Zero();
        entry.point = results[p]->point;
        entry.normal = results[p]->normal;
        cache_.store(hash.hex(), entry);
        if (keep) put_bodies(places[p], bodies);
      }
    }
    if (options_.step) options_.step();
  });
  return results;
}

std::vector<TorqueSolution> ContactLibrary::torques(const std::vector<Vec3>& positions,
                                                    const Material& material,
                                                    const std::string& description) const {
  const ContentHash common = key_of(material, "torque " + description);
  std::vector<TorqueSolution> results(positions.size());
  in_parallel(positions.size(), options_.threads, [&](std::size_t p) {
    ContentHash hash = common;
    hash.add(positions[p].data(), sizeof(double) * 3);
    if (const auto found = cache_.load(hash.hex()))
      if (auto known = unpacked(*found)) {
        results[p] = std::move(*known);
        return;
      }
    const std::shared_ptr<ContactBodies> bodies = take_bodies(positions[p]);
    results[p] = bodies->torque(material);
    put_bodies(positions[p], bodies);
    cache_.store(hash.hex(), packed(results[p]));
  });
  return results;
}

std::vector<MarkerSolution> ContactLibrary::markers(const std::vector<Vec3>& positions,
                                                    const std::vector<Vec3>& points,
                                                    const Material& material,
                                                    const std::string& description) const {
  ContentHash common = key_of(material, "markers " + description);
  for (const Vec3& point : points) common.add(point.data(), sizeof(double) * 3);
  std::vector<MarkerSolution> results(positions.size());
  in_parallel(positions.size(), options_.threads, [&](std::size_t p) {
    ContentHash hash = common;
    hash.add(positions[p].data(), sizeof(double) * 3);
    if (const auto found = cache_.load(hash.hex()))
      if (auto known = unpacked_markers(*found)) {
        results[p] = std::move(*known);
        return;
      }
    const std::shared_ptr<ContactBodies> bodies = take_bodies(positions[p]);
    results[p] = bodies->markers(material, points);
    put_bodies(positions[p], bodies);
    cache_.store(hash.hex(), packed(results[p]));
  });
  return results;
}

std::vector<std::shared_ptr<const FeatureEstimate>> ContactLibrary::estimates(
    const std::vector<Vec3>& positions) const {
  std::vector<std::shared_ptr<const FeatureEstimate>> estimates(positions.size());
  in_parallel(positions.size(), options_.threads, [&](std::size_t p) {
    std::shared_ptr<ContactBodies> bodies = take_bodies(positions[p]);
    estimates[p] = bodies->estimate(kTypicalPoisson);
    put_bodies(positions[p], std::move(bodies));
  });
  return estimates;
}

std::vector<PreparedContact> ContactLibrary::prepare(const std::vector<Vec3>& positions,
                                                     double nu_low, double nu_high) const {
  const std::vector<double> nus = poisson_nodes(nu_low, nu_high);
  std::vector<Task> tasks;
  for (std::size_t k = 0; k < nus.size(); ++k) {
    ContentHash key = key_of({nus[k], {1.0}, nullptr}, "homogeneous");
    // The others say where the sweep was factorised, and the last digits with it.
    for (const double nu : nus) key.add(nu);
    tasks.push_back({key, [this, &nus, k](ContactBodies& bodies, std::size_t) {
                       return bodies.solve_unit(nus, k, grid());
                     }});
  }
  const auto solutions = solve_all(positions, tasks, false);
  std::vector<PreparedContact> prepared(positions.size());
  for (std::size_t p = 0; p < positions.size(); ++p) {
    for (std::size_t k = 0; k < nus.size(); ++k)
      if (const std::string& unfit = solutions[p * nus.size() + k].unfit; !unfit.empty())
        prepared[p].unfit = unfit;
    if (!prepared[p].unfit.empty()) continue;
    for (std::size_t k = 0; k < nus.size(); ++k) {
      const StiffnessSolution& s = solutions[p * nus.size() + k];
      prepared[p].stiffness.add(nus[k], s.K, s.dK_dnu);
      prepared[p].coarse.add(nus[k], s.K + s.coarse_change, s.coarse_dK_dnu);
      prepared[p].mesh_uncertainty = std::max(prepared[p].mesh_uncertainty, mesh_uncertainty(s));
    }
    const StiffnessSolution& middle = solutions[p * nus.size() + nus.size() / 2];
    prepared[p].point = middle.point;
    prepared[p].normal = middle.normal;
    prepared[p].plan_share = middle.plan_share;
  }
  return prepared;
}

std::vector<StiffnessSolution> ContactLibrary::solve(const std::vector<Vec3>& positions,
                                                     const std::vector<PreparedContact>& contacts,
                                                     const Material& material,
                                                     const std::string& description) const {
  const auto solver = [&](ContactBodies& bodies, std::size_t p) {
    StiffnessSolution solution;
    if (options_.draft) {
      UnitPair fine, coarse;
      contacts[p].stiffness.evaluate(material.nu, fine.K, fine.by_nu);
      contacts[p].coarse.evaluate(material.nu, coarse.K, coarse.by_nu);
      solution = bodies.solve_corrected(material, fine, coarse);
    } else {
      solution = bodies.solve_featured(material);
    }
    // Meshes alone, where not all matrices have room.
    if (positions.size() * bodies.held_bytes() > memo().budget()) bodies.forget_systems();
    return solution;
  };
  const std::string kind = options_.draft ? "corrected " : "featured ";
  return solve_all(positions, {{key_of(material, kind + description), solver}}, true);
}

}  // namespace hapsim
