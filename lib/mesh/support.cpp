#include "mesh/support.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/error.h"
#include "io/csv.h"
#include "io/quantity.h"
#include "io/stream.h"

namespace hapsim {
namespace {

[[noreturn]] void fail_text(const std::string& text) {
  fail_usage("'" + text + "' names no support",
             "give bottom, plane:Z, plane:NX,NY,NZ,H, below:Z, box:X0,Y0,Z0,X1,Y1,Z1, file:PATH or "
             "none, in metres or with a unit (below:4mm), several joined by +");
}

std::vector<double> numbers_of(const std::string& list, const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t to = std::min(list.find(',', from), list.size());
    double value;
    if (!parse_number(std::string_view(list).substr(from, to - from), value)) fail_text(text);
    numbers.push_back(value);
    from = to + 1;
  }
  return numbers;
}

void read_file(const std::string& path, Support& support) {
  Input input(path);
  const CsvTable table = read_csv(input);
  if (table.find("node") >= 0 && table.find("x") < 0) {
    support.kind = SupportKind::kNodes;
    for (const double n : table.numbers("node")) {
      if (!(n >= 0 && n < 2147483647) || n != std::floor(n))
        fail_input(table.name, fmt::format("{} is no node number", n),
                   "number nodes from 0, as in the body file");
      support.nodes.push_back(static_cast<int>(n));
    }
  } else {
    support.kind = SupportKind::kPoints;
    const auto x = table.numbers("x"), y = table.numbers("y"), z = table.numbers("z");
    for (std::size_t i = 0; i < x.size(); ++i) support.points.emplace_back(x[i], y[i], z[i]);
  }
  if (support.nodes.empty() && support.points.empty())
    fail_input(table.name, "there is no point to fix", "give rows of x,y,z or of node");
}

Support parse_one(const std::string& text) {
  if (text == "bottom") return {};
  if (text == "none") return {SupportKind::kNone};
  const std::size_t split = text.find_first_of(":= ");
  if (split == std::string::npos) fail_text(text);
  const std::string kind = text.substr(0, split), rest = text.substr(split + 1);
  Support support;
  if (kind == "file" && !rest.empty()) {
    read_file(rest, support);
    return support;
  }
  // All are lengths but a plane's normal.
  const bool oriented = kind == "plane" && std::count(rest.begin(), rest.end(), ',') == 3;
  const std::size_t lengths = oriented ? rest.rfind(',') + 1 : 0;
  const std::vector<double> n =
      numbers_of(rest.substr(0, lengths) +
                     list_in_si(rest.substr(lengths), {Quantity::kLength}, "'" + text + "'"),
                 text);
  if (kind == "below" && n.size() == 1) {
    support.kind = SupportKind::kBelow;
    support.z = n[0];
  } else if (kind == "plane" && (n.size() == 1 || n.size() == 4)) {
    support.kind = SupportKind::kPlane;
    support.z = n.back();
    if (n.size() == 4) {
      const Vec3 normal(n[0], n[1], n[2]);
      if (!(normal.norm() > 0)) fail_text(text);
      support.normal = normal.normalized();
      support.z /= normal.norm();
    }
  } else if (kind == "box" && n.size() == 6) {
    support.kind = SupportKind::kBox;
    const Vec3 a(n[0], n[1], n[2]), b(n[3], n[4], n[5]);
    support.low = a.cwiseMin(b);
    support.high = a.cwiseMax(b);
  } else {
    fail_text(text);
  }
  return support;
}

}  // namespace

Support parse_support(const std::string& text) {
  // A plus within a number (1e+3) is followed by a digit.
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool joins = text[i] == '+' && i + 1 < text.size() &&
                       std::isalpha(static_cast<unsigned char>(text[i + 1])) != 0;
    if (joins)
      parts.emplace_back();
    else
      parts.back() += text[i];
  }
  Support support = parse_one(parts[0]);
  for (std::size_t i = 1; i < parts.size(); ++i) support.also.push_back(parse_one(parts[i]));
  return support;
}

bool bonds_faces(const Support& support) {
  return (support.kind != SupportKind::kNone && support.kind != SupportKind::kPoints &&
          support.kind != SupportKind::kNodes) ||
         std::any_of(support.also.begin(), support.also.end(), bonds_faces);
}

std::vector<std::uint8_t> bonded_faces(const std::vector<Vec3>& nodes,
                                       const std::vector<Triangle>& faces, const Support& support) {
  const Vec3 up = support.kind == SupportKind::kPlane ? support.normal : Vec3(Vec3::UnitZ());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Triangle& f : faces)
    for (const int n : f) {
      low = std::min(low, up.dot(nodes[n]));
      high = std::max(high, up.dot(nodes[n]));
    }
  const double tolerance = support.tolerance > 0 ? support.tolerance : 0.005 * (high - low);
  const auto bonded = [&](int n) {
    const Vec3& p = nodes[n];
    switch (support.kind) {
      case SupportKind::kBottom:
        return p.z() - low <= tolerance;
      case SupportKind::kPlane:
        return std::abs(up.dot(p) - support.z) <= tolerance;
      case SupportKind::kBelow:
        return p.z() <= support.z;
      case SupportKind::kBox:
        return (p.array() >= support.low.array()).all() &&
               (p.array() <= support.high.array()).all();
      case SupportKind::kNone:
      case SupportKind::kPoints:
      case SupportKind::kNodes:
        break;
    }
    return false;
  };
  std::vector<std::uint8_t> result;
  result.reserve(faces.size());
  for (const Triangle& f : faces) result.push_back(bonded(f[0]) && bonded(f[1]) && bonded(f[2]));
  for (const Support& other : support.also) {
    const auto more = bonded_faces(nodes, faces, other);
    for (std::size_t f = 0; f < result.size(); ++f) result[f] = result[f] != 0 || more[f] != 0;
  }
  return result;
}

std::vector<int> nodes_of_faces(const TetMesh& mesh, const std::vector<std::uint8_t>& chosen) {
  std::set<std::pair<int, int>> edges;
  std::set<int> nodes;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!chosen[f]) continue;
    for (int k = 0; k < 3; ++k) {
      nodes.insert(mesh.faces[f][k]);
      edges.insert(std::minmax(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]));
    }
  }
  if (mesh.order == 2)
    for (const auto& t : mesh.tets)
      for (int e = 0; e < 6; ++e)
        if (edges.count(std::minmax(t[kTetEdges[e][0]], t[kTetEdges[e][1]])) > 0)
          nodes.insert(t[4 + e]);
  return {nodes.begin(), nodes.end()};
}

int fix_faces(TetMesh& mesh, const std::vector<std::uint8_t>& bonded) {
  mesh.fixed.assign(mesh.nodes.size(), 0);
  const std::vector<int> nodes = nodes_of_faces(mesh, bonded);
  for (const int n : nodes) mesh.fixed[n] = 1;
  return static_cast<int>(nodes.size());
}

void fix_named_nodes(TetMesh& mesh, const Support& support, const std::string& where) {
  for (const Support& other : support.also) fix_named_nodes(mesh, other, where);
  for (const int n : support.nodes) {
    if (n >= static_cast<int>(mesh.nodes.size()))
      fail_input(where,
                 fmt::format("node {} is to be fixed, and there are {}", n, mesh.nodes.size()),
                 "number nodes from 0, as in the body file");
    mesh.fixed[n] = 1;
  }
  if (support.points.empty()) return;
  double longest = 0;
  std::set<int> boundary;
  for (const Triangle& f : mesh.faces)
    for (int k = 0; k < 3; ++k) {
      boundary.insert(f[k]);
      longest = std::max(longest, (mesh.nodes[f[k]] - mesh.nodes[f[(k + 1) % 3]]).norm());
    }
  for (const Vec3& p : support.points) {
    int best = -1;
    double nearest = longest;
    for (const int n : boundary)
      if (const double d = (mesh.nodes[n] - p).norm(); d <= nearest) {
        nearest = d;
        best = n;
      }
    if (best < 0)
      fail_input(where,
                 fmt::format("the point to be fixed at ({:.6g}, {:.6g}, {:.6g}) lies farther than "
                             "{:.3g} m off every node of the surface",
                             p.x(), p.y(), p.z(), longest),
                 "check the unit and the frame of the points");
    mesh.fixed[best] = 1;
  }
}

int fix_bottom(TetMesh& mesh) {
  return fix_faces(mesh, bonded_faces(mesh.nodes, mesh.faces, Support{}));
}

}  // namespace hapsim
