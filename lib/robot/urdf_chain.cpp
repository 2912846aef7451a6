#include "robot/urdf_chain.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/nearest.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr std::size_t kLargest = 64u << 20;
constexpr int kDeepest = 200;
constexpr int kMostLinks = 10000;
// TinyXML skips as many bytes as the first of a UTF-8 character promises, up to three of them
// beyond the end of a text that is cut there.
constexpr const char* kPadding = "\n\n\n\n";

// Keeps the parser's first complaint instead of letting it print. urdfdom gives what it quotes to
// printf as part of the format: where a percent sign can be quoted it is not let complain.
class Complaints : public console_bridge::OutputHandler {
 public:
  explicit Complaints(const std::string& urdf) {
    const bool percent =
        urdf.find('%') != std::string::npos || urdf.find("&#") != std::string::npos;
    if (percent) {
      console_bridge::noOutputHandler();
    } else {
      console_bridge::useOutputHandler(this);
    }
  }
  ~Complaints() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  std::string first() const {
    std::string line = first_;
    std::replace(line.begin(), line.end(), '\n', ' ');
    return line.empty() ? "it is no valid robot description" : line;
  }

 private:
  std::string first_;
};

// The parser goes down one call a level, and frees a chain of links one call a link: text that
// opens tags without end, or a chain without end, would exhaust the stack.
void check_text(const std::string& urdf, const std::string& name) {
  if (urdf.size() > kLargest) {
    fail_input(name, "the robot description is larger than 64 MB", "give a URDF file");
  }
  int depth = 0, links = 0;
  for (std::size_t at = urdf.find('<'); at != std::string::npos; at = urdf.find('<', at + 1)) {
    if (urdf.compare(at, 4, "<!--") == 0) {
      at = std::min(urdf.find("-->", at), urdf.size() - 1);
      continue;
    }
    const char next = at + 1 < urdf.size() ? urdf[at + 1] : ' ';
    for (const char* tag : {"<link", "<joint"})
      links += urdf.compare(at, std::strlen(tag), tag) == 0;
    if (links > 2 * kMostLinks) {
      fail_input(name, fmt::format("it has more than {} links", kMostLinks),
                 "give the robot's own description");
    }
    const std::size_t end = urdf.find('>', at);
    if (next == '?' || next == '!') continue;
    if (next == '/') {
      --depth;
    } else if (end == std::string::npos || urdf[end - 1] != '/') {
      ++depth;
    }
    if (depth > kDeepest) {
      fail_input(name, "tags are nested more than 200 deep", "give a URDF file");
    }
  }
  if (urdf.find("<robot") == std::string::npos) {
    const bool xacro = urdf.find("xacro") != std::string::npos;
    fail_input(name, "there is no <robot> in it",
               xacro ? "expand it first: xacro FILE > robot.urdf" : "give a URDF file");
  }
}

const urdf::Link& require_link(const urdf::ModelInterface& model, const std::string& link,
                               const std::string& name) {
  const auto found = model.getLink(link);
  if (found) return *found;
  std::vector<std::string> names;
  for (const auto& entry : model.links_) names.push_back(entry.first);
  const std::string near = nearest(link, names);
  std::string list;
  for (const std::string& n : names) list += (list.empty() ? "" : " ") + n;
  fail_input(
      name, "the robot has no link " + shown(link),
      near.empty() ? "its links are: " + list.substr(0, 400) : "did you mean " + shown(near) + "?");
}

std::string only_end(const urdf::ModelInterface& model, const std::string& name) {
  std::vector<std::string> ends;
  for (const auto& [link, what] : model.links_) {
    if (what->child_joints.empty()) ends.push_back(link);
  }
  if (ends.size() == 1) return ends.front();
  std::string list;
  for (const std::string& end : ends) list += (list.empty() ? "" : ", ") + end;
  fail_input(name, fmt::format("the robot ends in {} links", ends.size()),
             "choose one by --tip-link: " + list.substr(0, 400));
}

ChainJoint convert(const urdf::Joint& joint, const std::string& name) {
  const auto fail = [&](const std::string& wrong, const std::string& mend) {
    fail_input(name, "joint " + shown(joint.name) + " " + wrong, mend);
  };
  ChainJoint result;
  result.joint.name = joint.name;
  const urdf::Pose& pose = joint.parent_to_joint_origin_transform;
  Eigen::Quaterniond turn;
  pose.rotation.getQuaternion(turn.x(), turn.y(), turn.z(), turn.w());
  result.origin.linear() = turn.normalized().toRotationMatrix();
  result.origin.translation() = Vec3(pose.position.x, pose.position.y, pose.position.z);
  if (!result.origin.matrix().allFinite()) fail("has no finite origin", "mend its <origin>");
  if (joint.type == urdf::Joint::FIXED) {
    result.fixed = true;
    return result;
  }
  if (joint.mimic) fail("follows another joint (mimic)", "choose a --tip-link before it");
  const bool slides = joint.type == urdf::Joint::PRISMATIC;
  const bool endless = joint.type == urdf::Joint::CONTINUOUS;
  if (!slides && !endless && joint.type != urdf::Joint::REVOLUTE) {
    fail("neither turns nor slides about one axis",
         "choose a chain without it by --root, --tip-link");
  }
  result.axis = Vec3(joint.axis.x, joint.axis.y, joint.axis.z);
  if (const double length = result.axis.norm(); !(length > 1e-6 && std::isfinite(length))) {
    fail("has no axis", "give <axis xyz=...> a direction");
  }
  result.axis.normalize();
  result.joint.turns = !slides;
  const double far = std::numeric_limits<double>::infinity();
  result.joint.lower = !endless && joint.limits ? joint.limits->lower : -far;
  result.joint.upper = !endless && joint.limits ? joint.limits->upper : far;
  if (!(result.joint.lower <= result.joint.upper)) {
    fail("has a lower limit above its upper one", "mend its <limit>");
  }
  return result;
}

}  // namespace

UrdfChain read_urdf_chain(const std::string& urdf, const std::string& name, const std::string& root,
                          const std::string& tip) {
  check_text(urdf, name);
  const Complaints complaints(urdf);
  urdf::ModelInterfaceSharedPtr model;
  std::string thrown;
  try {
    model = urdf::parseURDF(urdf + kPadding);
  } catch (const std::exception& error) {
    thrown = error.what();
  }
  if (!model || !model->getRoot()) {
    fail_input(name, "cannot be read as URDF: " + (thrown.empty() ? complaints.first() : thrown),
               "check it, for example with check_urdf");
  }
  UrdfChain chain;
  chain.root = root.empty() ? model->getRoot()->name : require_link(*model, root, name).name;
  chain.tip = tip.empty() ? only_end(*model, name) : require_link(*model, tip, name).name;
  std::string at = chain.tip;
  for (std::size_t steps = 0; at != chain.root; ++steps) {
    const urdf::Link& link = require_link(*model, at, name);
    if (!link.parent_joint || steps > model->links_.size()) {
      fail_input(name, "link " + shown(chain.tip) + " is not carried by link " + shown(chain.root),
                 "choose another --root");
    }
    chain.joints.push_back(convert(*link.parent_joint, name));
    at = link.parent_joint->parent_link_name;
  }
  std::reverse(chain.joints.begin(), chain.joints.end());
  if (std::all_of(chain.joints.begin(), chain.joints.end(),
                  [](const ChainJoint& j) { return j.fixed; })) {
    fail_input(name, "no joint moves between " + shown(chain.root) + " and " + shown(chain.tip),
               "choose another --tip-link");
  }
  return chain;
}

}  // namespace hapsim
