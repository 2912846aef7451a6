#include "fit/constraint_regions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cctype>
#include <optional>

#include "base/error.h"
#include "experiment/nearest_region.h"
#include "model/body_parameters.h"

namespace hapsim {
namespace {

std::vector<std::string> apart_by_commas(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

// The region of the tetrahedron whose corners enclose p; none outside.
std::optional<int> region_of_body(const TetMesh& body, const Vec3& p) {
  constexpr double kOnFace = -1e-9;  // a share of a corner
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    const auto& nodes = body.tets[t];
    const Vec3& origin = body.nodes[static_cast<std::size_t>(nodes[0])];
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
      edges.col(k) =
          body.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(k) + 1])] - origin;
    const Vec3 share = edges.partialPivLu().solve(p - origin);
    if (share.minCoeff() >= kOnFace && share.sum() <= 1 - kOnFace)
      return body.region.empty() ? 0 : body.region[t];
  }
  return std::nullopt;
}

int region_at(const std::string& point, const std::string& of, const Model& model,
              const TetMesh& body) {
  const std::vector<std::string> parts = apart_by_commas(point);
  Vec3 p = Vec3::Zero();
  for (std::size_t k = 0; k < parts.size(); ++k)
    p[static_cast<Eigen::Index>(k)] = std::stod(parts[k]);
  const MaterialSpec material = material_of(model);
  for (const FeatureSpec& f : material.features)
    if (f.feature.kind == Feature::kLayer || f.feature.kind == Feature::kInclusion)
      fail_usage(
          "a point says nothing of regions where the model has a layer or an inclusion, in '" + of +
              "'",
          "write the relation between its parameters");
  const bool in_plan = !material.key_point.empty();
  if (in_plan && parts.size() == 2) return region_at(material, p);
  if (parts.size() != 3)
    fail_usage("the point (" + point + ") of '" + of + "' needs three coordinates",
               "the model does not divide the body in plan view: give x, y and z");
  const std::optional<int> region = region_of_body(body, p);
  if (!region)
    fail_usage("nothing of the body is at (" + point + "), in '" + of + "'",
               "give a point inside the body, in metres or with a unit");
  return in_plan ? region_at(material, p) : *region;
}

std::string numbered(const std::string& name, const std::string& of,
                     const std::vector<std::string>& names, const Model& model,
                     const TetMesh& body) {
  const std::size_t bracket = name.find('[');
  if (bracket == std::string::npos) return name;
  const std::string region = name.substr(bracket + 1, name.size() - bracket - 2);
  if (region.find_first_not_of("0123456789") == std::string::npos) return name;
  std::ptrdiff_t number = 0;
  if (region.find(',') != std::string::npos) {
    number = region_at(region, of, model, body);
  } else {
    number = std::find(names.begin(), names.end(), region) - names.begin();
    if (number == static_cast<std::ptrdiff_t>(names.size())) {
      std::string known;
      for (const std::string& one : names) known += (known.empty() ? "" : ", ") + one;
      fail_usage("no region is called '" + region + "', of '" + of + "'",
                 names.empty() ? "name regions 0, 1, ... by --region-names, or write their number"
                               : "regions 0, 1, ... are called " + known);
    }
  }
  return name.substr(0, bracket) + "[" + std::to_string(number) + "]";
}

}  // namespace

std::vector<std::string> region_names(const std::string& text, const std::string& option) {
  std::vector<std::string> names;
  for (std::string name : apart_by_commas(text)) {
    const auto is_blank = [](unsigned char c) { return std::isspace(c) != 0; };
    name.erase(std::remove_if(name.begin(), name.end(), is_blank), name.end());
    const bool is_word = !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0 &&
                         std::all_of(name.begin(), name.end(), [](unsigned char c) {
                           return std::isalnum(c) != 0 || c == '_';
                         });
    if (!is_word)
      fail_usage(option + ": '" + name + "' is no name of a region",
                 "letters, digits and _ after a letter, apart by commas: liver,tumour");
    if (std::find(names.begin(), names.end(), name) != names.end())
      fail_usage(option + ": '" + name + "' stands twice", "give each region a name of its own");
    names.push_back(name);
  }
  return names;
}

std::vector<Relation> number_regions(const std::vector<Relation>& constraints, const Model& model,
                                     const TetMesh& body) {
  std::vector<std::string> names;
  if (const auto listed = model.metadata.find("region_names"))
    names = region_names(*listed, "region_names of the model");
  std::vector<Relation> result = constraints;
  for (Relation& one : result) {
    std::vector<std::string> renamed;
    for (const std::string& name : one.difference.names())
      renamed.push_back(numbered(name, one.text, names, model, body));
    one.difference = one.difference.renamed(renamed);
  }
  return result;
}

}  // namespace hapsim
