#include "simulate/full_simulation.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "base/error.h"
#include "experiment/dataset.h"
#include "experiment/forces.h"
#include "io/number.h"
#include "nonlinear/tool_body.h"
#include "simulate/full_body.h"
#include "simulate/full_contact.h"
#include "simulate/tool_steps.h"

namespace hapsim {
namespace {

// One press: its mesh and its body.
struct Session {
  ContactMesh own;  // unless the body's mesh serves
  const TetMesh* mesh = nullptr;
  std::vector<FullContact> contacts;
  std::unique_ptr<ToolBody> body;
  double last_time = 0;
};

// The middle node of each edge to its middle.
void straighten(TetMesh& mesh) {
  for (const auto& t : mesh.tets)
    for (int e = 0; e < 6; ++e)
      mesh.nodes[t[4 + e]] =
          0.5 * (mesh.nodes[t[kTetEdges[e][0]]] + mesh.nodes[t[kTetEdges[e][1]]]);
}

// Of a flat tool: to its outermost node. The rim is a polygon of the circle's area, whose corners
// lie outside of the circle.
double reach_of(const TetMesh& mesh, const FullContact& contact) {
  double farthest = 0;
  for (const int n : contact.nodes)
    farthest = std::max(farthest, (mesh.nodes[n] - contact.point).norm());
  return farthest * (1 + 1e-9);
}

class Simulation {
 public:
  Simulation(const TetMesh& body, const Model& model, const Recording& recording,
             const FullOptions& options)
      : body_(body),
        recording_(recording),
        options_(options),
        full_(body, model, options),
        radius_(recording.tool_radius()) {}

  FullResult run() {
    result_.force.assign(recording_.rows(), Vec3::Zero());
    result_.motion = recording_.u;
    const bool goes_on = recording_.metadata.find("recovery").value_or("") == "none";
    std::vector<Vec3> before;
    int number = 0;
    for (const ToolSteps& steps : tool_steps(recording_)) {
      std::vector<Vec3> points;
      const std::vector<std::size_t> first = steps.first_rows();
      for (const std::size_t row : first) points.push_back(recording_.position[row]);
      const std::size_t begin = *std::min_element(first.begin(), first.end());
      const bool continues = goes_on && session_ && points == before && !recording_.t.empty() &&
                             recording_.t[begin] >= session_->last_time;
      before = points;
      if (!continues) prepare(steps);
      solve(steps, continues, ++number);
    }
    return std::move(result_);
  }

  // The first row's press alone, in steps from outside.
  void begin() {
    if (!full_.around().empty())
      fail_input("",
                 "steps from outside are of the body itself, without " +
                     full_.around().front().effect->card().name,
                 "take it out of the model");
    ToolSteps steps;
    steps.rows = {{0}};
    prepare(steps);
  }
  Vec3 advance(const Vec3& u, double dt) {
    const SolveReport report = session_->body->step({{u, false}}, dt);
    if (!report.ok()) {
      const std::size_t split = report.message.find("; ");
      fail_numerics(recording_.name, report.message.substr(0, split),
                    report.message.substr(split + 2));
    }
    return session_->body->force(0);
  }
  Session& session() { return *session_; }

 private:
  bool bonded() const {
    return full_.spec().curvature == 0 && !std::isfinite(full_.spec().friction);
  }
  // A flat tool that slips at finite strain leaves the stress that quarter points are for.
  bool slips_far() const { return full_.spec().finite && full_.spec().curvature == 0 && !bonded(); }

  void prepare(const ToolSteps& steps) {
    session_ = std::make_unique<Session>();
    Session& s = *session_;
    const std::vector<std::size_t> rows = steps.first_rows();
    if (rows.size() == 1 && !options_.own_mesh) {
      s.own = make_contact_mesh(
          full_.base(), recording_.position[rows[0]], radius_, radius_ * options_.rim_edge,
          options_.growth > 0 ? options_.growth : kGrowth * options_.rim_edge / kRimEdge);
      if (!options_.quarter_points || slips_far()) straighten(s.own.mesh);
      s.mesh = &s.own.mesh;
      s.contacts = {{s.own.point, s.own.normal, s.own.patch_nodes}};
    } else {
      s.mesh = &body_;
      for (const std::size_t row : rows) {
        s.contacts.push_back(full_contact(body_, recording_.position[row], radius_));
        if (s.contacts.back().normal.norm() > 0 && !s.contacts.back().nodes.empty()) continue;
        fail_input(recording_line(recording_, row), "no free node of the body lies under the tool",
                   "mesh it with hs-tetmesh --contacts, or check the contact point");
      }
    }
    if (bonded()) refuse_shared_nodes(rows);
    std::vector<BodyTool> tools;
    for (const FullContact& c : s.contacts) {
      BodyTool tool;
      if (bonded())
        tool.nodes = c.nodes;
      else if (full_.spec().curvature == 0)
        tool.tip =
            SphericalTip{c.point, c.normal, kSticks, reach_of(*s.mesh, c), full_.spec().friction};
      else
        tool.tip = SphericalTip{c.point, c.normal, 1 / full_.spec().curvature, 1.6 * radius_,
                                full_.spec().friction};
      tools.push_back(std::move(tool));
    }
    bool free_base = false;
    const BodyModel model = full_.model(*s.mesh, free_base);
    std::vector<std::vector<Relaxation>> relaxation;  // none where there is no time
    if (!recording_.t.empty()) relaxation = full_.relaxation();
    s.body = std::make_unique<ToolBody>(model, tools, relaxation, free_base);
    s.body->set_options(options_.solve);
    result_.unknowns = std::max(result_.unknowns, s.body->body().unknowns());
  }

  // A node moves with one bonded tool.
  void refuse_shared_nodes(const std::vector<std::size_t>& rows) const {
    std::map<int, std::size_t> row_of;
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (const int node : session_->contacts[k].nodes)
        if (!row_of.try_emplace(node, rows[k]).second)
          fail_input(recording_line(recording_, rows[k]),
                     "this place overlaps that of " + recording_line(recording_, row_of[node]) +
                         ", which is pressed before this body comes to rest",
                     "press two radii apart, or exactly there again");
  }

  // The press of one tool as effects see it.
  PressView view_of(const std::vector<std::size_t>& rows, std::size_t tool, int number) const {
    PressView view;
    const double start = recording_.t.empty() ? 0 : recording_.t[rows.front()];
    const double began = session_start(recording_);
    for (const std::size_t row : rows) add_sample(view, recording_, row, start, began);
    view.normal = session_->contacts[tool].normal;
    view.direction = -view.normal;
    view.number = number;
    view.radius = radius_;
    view.modulus = full_.material().modulus[0];
    return view;
  }

  void solve(const ToolSteps& steps, bool continues, int number) {
    Session& s = *session_;
    const std::size_t tools = steps.touches();
    std::vector<PressView> views;
    std::vector<std::vector<std::size_t>> rows(tools);  // of each touch
    for (std::size_t k = 0; k < tools; ++k) {
      for (const std::vector<std::size_t>& step : steps.rows)
        if (step[k] != ToolSteps::kNoRow) rows[k].push_back(step[k]);
      views.push_back(view_of(rows[k], k, number));
      Motion motion{views[k].u, {}, 0};
      for (const EffectInstance& i : full_.around()) i.effect->move(views[k], i.values, motion);
      views[k].u = std::move(motion.u);
    }
    const bool tip = full_.spec().curvature > 0 || std::isfinite(full_.spec().friction);
    std::vector<std::size_t> next(tools, 0);  // row of each touch
    for (std::size_t i = 0; i < steps.rows.size(); ++i) {
      const std::vector<std::size_t>& step = steps.rows[i];
      const std::size_t row = *std::min_element(step.begin(), step.end());
      const double time = recording_.t.empty() ? 0 : recording_.t[row];
      const double dt = i > 0 || continues ? time - s.last_time : 0;
      std::vector<ToolTarget> targets;
      for (std::size_t k = 0; k < tools; ++k) {
        const bool rests = step[k] == ToolSteps::kNoRow;
        const std::size_t at = rests ? 0 : next[k]++;
        // A bonded tool that is away lets go: it exerts nothing; a tip is away.
        if (rests || views[k].in_air[at])
          targets.push_back(tip ? ToolTarget{radius_ * s.contacts[k].normal, false}
                                : ToolTarget{Vec3::Zero(), true});
        else if (options_.force_control)
          targets.push_back({recording_.f[step[k]], true});
        else
          targets.push_back({views[k].u[at], false});
      }
      const SolveReport report = s.body->step(targets, dt);
      result_.newton_steps += report.newton_steps;
      if (!report.ok()) {
        const std::size_t split = report.message.find("; ");
        fail_numerics(recording_line(recording_, row), report.message.substr(0, split),
                      report.message.substr(split + 2));
      }
      s.last_time = time;
      std::size_t done = 0;
      for (std::size_t k = 0; k < tools; ++k) {
        if (step[k] == ToolSteps::kNoRow) continue;
        const int tool = static_cast<int>(k);
        result_.force[step[k]] = s.body->force(tool);
        if (options_.force_control) result_.motion[step[k]] = s.body->motion(tool);
        ++done;
      }
      if (options_.observe)
        options_.observe({row, s.mesh, &s.body->body().field(), s.body->body().element_fields()});
      if (options_.step) options_.step(done);
    }
    for (std::size_t k = 0; k < tools; ++k) {
      Signal signal{Eigen::VectorXd(3 * static_cast<Eigen::Index>(rows[k].size())), {}};
      signal.df.resize(signal.f.size(), 0);
      for (std::size_t i = 0; i < rows[k].size(); ++i)
        signal.f.segment<3>(3 * static_cast<Eigen::Index>(i)) = result_.force[rows[k][i]];
      for (const EffectInstance& i : full_.around())
        if (i.effect->card().stage == Stage::kSensor) i.effect->apply(views[k], i.values, signal);
      for (std::size_t i = 0; i < rows[k].size(); ++i)
        result_.force[rows[k][i]] = signal.f.segment<3>(3 * static_cast<Eigen::Index>(i));
    }
  }

  const TetMesh& body_;
  const Recording& recording_;
  const FullOptions& options_;
  FullBody full_;
  double radius_;
  std::unique_ptr<Session> session_;
  FullResult result_;
};

}  // namespace

FullResult simulate_full(const TetMesh& body, const Model& model, const Recording& recording,
                         const FullOptions& options) {
  return Simulation(body, model, recording, options).run();
}

struct FullPress::Impl {
  Impl(const TetMesh& body, const Model& model, const Vec3& contact, double tool_radius,
       const FullOptions& full)
      : options(full),
        recording(one_row(contact, tool_radius)),
        simulation(body, model, recording, options) {
    simulation.begin();
    start = simulation.session().body->state();
  }
  static Recording one_row(const Vec3& contact, double tool_radius) {
    Recording r;
    r.name = "press";
    r.metadata.set("tool_radius", format_number(tool_radius));
    r.line = {1};
    r.press = {1};
    r.t = {0};
    r.position = {contact};
    r.u = {Vec3::Zero()};
    return r;
  }
  FullOptions options;
  Recording recording;
  Simulation simulation;
  ToolBody::State start;
};

FullPress::FullPress(const TetMesh& body, const Model& model, const Vec3& contact,
                     double tool_radius, const FullOptions& options)
    : impl_(std::make_unique<Impl>(body, model, contact, tool_radius, options)) {}
FullPress::~FullPress() = default;
Vec3 FullPress::step(const Vec3& u, double dt) {
  return impl_->simulation.advance(u, dt);
}
void FullPress::reset() {
  impl_->simulation.session().body->restore(impl_->start);
}
const Vec3& FullPress::normal() const {
  return impl_->simulation.session().contacts[0].normal;
}
std::optional<Eigen::Matrix3d> FullPress::stiffness() {
  return impl_->simulation.session().body->stiffness(0);
}
std::optional<StressResponse> FullPress::stress_response(const Eigen::MatrixXd& inside) {
  return impl_->simulation.session().body->stress_response(0, inside);
}
std::optional<Eigen::MatrixXd> FullPress::fields() {
  return impl_->simulation.session().body->fields(0);
}
StressResponse FullPress::stress_response(const Eigen::MatrixXd& fields,
                                          const Eigen::MatrixXd& inside,
                                          const StressPart& part) const {
  return impl_->simulation.session().body->stress_response(fields, inside, part);
}
std::optional<Eigen::MatrixXd> FullPress::moved_inside(const Eigen::MatrixXd& stresses) {
  return impl_->simulation.session().body->moved_inside(stresses);
}
Eigen::VectorXd FullPress::stresses() const {
  return impl_->simulation.session().body->body().elastic_stresses().numbers();
}
const ToolBody::State& FullPress::state() const {
  return impl_->simulation.session().body->state();
}
void FullPress::restore(const ToolBody::State& state) {
  impl_->simulation.session().body->restore(state);
}

}  // namespace hapsim
