// Tips pressed against the body.
#include <set>

#include "nonlinear/coulomb_contact.h"
#include "nonlinear/nonlinear_body_impl.h"

namespace hapsim {
namespace {

// Columns of a tip's directions() for some hats: the normals alone where there is no friction.
std::vector<Index> columns_of(const TipContact& contact, const std::vector<Index>& hats) {
  std::vector<Index> columns;
  for (const Index h : hats)
    for (Index c = 0; c < (contact.tip().friction == 0 ? 1 : 3); ++c) columns.push_back(3 * h + c);
  return columns;
}

}  // namespace

MatrixXd NonlinearBody::Impl::fields_of(Tip& t, const std::vector<Index>& columns) {
  if (linear && t.fields.size() == 0) t.fields = system.solve(MatrixXd(t.contact.directions()));
  if (linear) return t.fields(Eigen::all, columns);
  if (columns.empty()) return MatrixXd(u.size(), 0);
  MatrixXd unit(u.size(), static_cast<Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c)
    unit.col(static_cast<Index>(c)) = t.contact.directions().col(columns[c]);
  return system.solve(unit);
}

bool NonlinearBody::Impl::add_contact(VectorXd& change) {
  std::vector<std::vector<Index>> hats(tips.size());
  for (std::size_t k = 0; k < tips.size(); ++k) {
    const VectorXd apart =
        tips[k].contact.apart() + tips[k].contact.directions().transpose() * change;
    for (Index h = 0; h < apart.size() / 3; ++h)
      if (apart[3 * h] < 0 || tips[k].traction[3 * h] > 0) hats[k].push_back(h);
  }
  for (int round = 0; round < 10; ++round) {
    const VectorXd with = settle_contact(hats, change);
    if (with.size() == 0) return false;
    bool all = true;
    for (std::size_t k = 0; k < tips.size(); ++k) {
      const VectorXd apart =
          tips[k].contact.apart() + tips[k].contact.directions().transpose() * with;
      std::vector<Index> next;
      for (Index h = 0; h < apart.size() / 3; ++h)
        if (apart[3 * h] < -1e-9 * tips[k].contact.surface().area[h] * tips[k].contact.give() ||
            std::binary_search(hats[k].begin(), hats[k].end(), h))
          next.push_back(h);
      all = all && next.size() == hats[k].size();
      hats[k] = next;
    }
    if (!all) continue;
    change = with;
    return true;
  }
  return false;
}

VectorXd NonlinearBody::Impl::settle_contact(const std::vector<std::vector<Index>>& hats,
                                             const VectorXd& change) {
  Index places = 0;
  for (const auto& h : hats) places += static_cast<Index>(h.size());
  if (places == 0) {
    for (Tip& t : tips) t.traction.setZero();
    return change;
  }
  MatrixXd compliance = MatrixXd::Identity(3 * places, 3 * places);
  VectorXd apart = VectorXd::Zero(3 * places), traction = apart;
  std::vector<double> friction;
  std::vector<MatrixXd> fields;
  std::vector<std::vector<Index>> columns;
  std::vector<std::vector<Index>> rows;  // of the dense problem, as `columns`
  for (std::size_t k = 0; k < tips.size(); ++k) {
    Tip& t = tips[k];
    const Index first = static_cast<Index>(friction.size());
    friction.insert(friction.end(), hats[k].size(), t.contact.tip().friction);
    columns.push_back(columns_of(t.contact, hats[k]));
    fields.push_back(fields_of(t, columns.back()));
    rows.emplace_back();
    const Index parts = t.contact.tip().friction == 0 ? 1 : 3;
    for (std::size_t c = 0; c < columns[k].size(); ++c) {
      const Index i = static_cast<Index>(c);
      rows[k].push_back(3 * (first + i / parts) + i % parts);
    }
    const VectorXd w = t.contact.apart() + t.contact.directions().transpose() * change;
    apart(rows[k]) = w(columns[k]);
    traction(rows[k]) = t.traction(columns[k]);
  }
  for (std::size_t a = 0; a < tips.size(); ++a)
    for (std::size_t b = 0; b < tips.size(); ++b) {
      const MatrixXd all = tips[a].contact.directions().transpose() * fields[b];
      compliance(rows[a], rows[b]) = all(columns[a], Eigen::all);
    }
  compliance = (0.5 * (compliance + compliance.transpose())).eval();
  if (!solve_coulomb_contact(compliance, apart, friction, traction)) return {};
  VectorXd with = change;
  for (std::size_t k = 0; k < tips.size(); ++k) {
    const VectorXd p = traction(rows[k]);
    tips[k].traction.setZero();
    tips[k].traction(columns[k]) = p;
    with += fields[k] * p;
  }
  return with;
}

void NonlinearBody::Impl::hold_contact() {
  Cliques cliques = assembly.cliques();
  for (Tip& t : tips) {
    const TipSurface& surface = t.contact.surface();
    std::vector<std::set<int>> nodes(static_cast<std::size_t>(t.contact.hats()));
    for (const TipSurface::Point& p : surface.points)
      for (const int h : p.hat)
        nodes[h].insert(surface.faces[p.face].begin(), surface.faces[p.face].end());
    t.first_clique = cliques.size();
    for (const std::set<int>& n : nodes) cliques.add({n.begin(), n.end()});
  }
  system = NodeSystem(free_nodes(handle), std::move(cliques));
  holds = true;
}

void NonlinearBody::Impl::add_contact_springs() {
  constexpr double kSprings = 10;  // of the modulus, over the tip's reach
  for (const Tip& t : tips)
    for (Index h = 0; h < t.contact.hats(); ++h) {
      const Vec3 p = t.traction.segment<3>(3 * h);
      if (!(p[0] > 0)) continue;
      const bool sticks = p.tail<2>().norm() < t.contact.tip().friction * p[0];
      const std::size_t clique = t.first_clique + static_cast<std::size_t>(h);
      const int count = system.cliques().count(clique);
      const MatrixXd by = t.contact.directions().middleCols(3 * h, sticks ? 3 : 1);
      MatrixXd own(3 * count, by.cols());
      for (int a = 0; a < count; ++a)
        own.middleRows<3>(3 * a) = by.middleRows<3>(3 * system.cliques().nodes(clique)[a]);
      const double stiffness =
          kSprings * assembly.modulus() / (t.contact.tip().reach * t.contact.surface().area[h]);
      system.add(clique, stiffness * own * own.transpose());
    }
}

void NonlinearBody::Impl::evaluate_tips() {
  for (Tip& t : tips) t.contact.evaluate(u, t.motion);
}

bool NonlinearBody::Impl::fits() const {
  for (const Tip& t : tips) {
    const double allowed = 1e-9 * t.contact.give() + 1e-14 * t.contact.tip().reach;
    for (Index i = 0; i < t.traction.size() / 3; ++i) {
      const double gap = t.contact.apart()[3 * i] / t.contact.surface().area[i];
      if ((t.traction[3 * i] > 0 ? std::abs(gap) : -gap) > allowed) return false;
    }
  }
  return true;
}

SolveStatus NonlinearBody::Impl::step_with_tips(VectorXd change) {
  if (!add_contact(change)) return SolveStatus::kNoConvergence;
  const VectorXd start = u;
  for (double share = 1; share > 0.05; share /= 2) {
    u = start + share * change;
    if (!assembly.set_state(u)) continue;
    evaluate_tips();
    return SolveStatus::kConverged;
  }
  return SolveStatus::kInverted;
}

SolveStatus NonlinearBody::Impl::settled() const {
  for (const Tip& t : tips)
    if (t.contact.at_rim(t.traction)) return SolveStatus::kOffSurface;
  return SolveStatus::kConverged;
}

}  // namespace hapsim
