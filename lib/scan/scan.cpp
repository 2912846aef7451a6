#include "scan/scan.h"

#include <algorithm>

namespace hapsim {
namespace {

template <class T>
std::vector<T> picked(const std::vector<T>& all, const std::vector<int>& index) {
  std::vector<T> result;
  if (all.empty()) return result;
  result.reserve(index.size());
  for (const int i : index) result.push_back(all[static_cast<std::size_t>(i)]);
  return result;
}

// A property that only one of two scans has is known of no point of both.
template <class T>
void join(std::vector<T>& a, std::size_t count_a, const std::vector<T>& b, std::size_t count_b) {
  if (a.size() == count_a && b.size() == count_b) {
    a.insert(a.end(), b.begin(), b.end());
  } else {
    a.clear();
  }
}

std::string free_name(const std::vector<std::string>& taken, const std::string& wanted) {
  std::string name = wanted;
  for (int k = 2; std::find(taken.begin(), taken.end(), name) != taken.end(); ++k) {
    name = wanted + "-" + std::to_string(k);
  }
  return name;
}

}  // namespace

Scan pick(const Scan& scan, const std::vector<int>& index) {
  Scan result;
  result.cloud.points = picked(scan.cloud.points, index);
  result.cloud.normals = picked(scan.cloud.normals, index);
  result.to_sensor = picked(scan.to_sensor, index);
  result.zone = picked(scan.zone, index);
  result.zone_names = scan.zone_names;
  result.touch_force = picked(scan.touch_force, index);
  result.notes = scan.notes;
  return result;
}

void append_zone(Scan& scan, const Scan& more, const std::string& zone) {
  const std::size_t count = scan.cloud.points.size(), added = more.cloud.points.size();
  if (scan.zone.empty()) {
    scan.zone.assign(count, 0);
    scan.zone_names = {"1"};
  }
  const int first = static_cast<int>(scan.zone_names.size());
  if (more.zone.empty()) {
    scan.zone_names.push_back(free_name(scan.zone_names, zone));
    scan.zone.insert(scan.zone.end(), added, first);
  } else {
    for (const std::string& name : more.zone_names) {
      scan.zone_names.push_back(free_name(scan.zone_names, name));
    }
    for (const int z : more.zone) scan.zone.push_back(first + z);
  }
  join(scan.cloud.normals, count, more.cloud.normals, added);
  join(scan.to_sensor, count, more.to_sensor, added);
  join(scan.touch_force, count, more.touch_force, added);
  scan.cloud.points.insert(scan.cloud.points.end(), more.cloud.points.begin(),
                           more.cloud.points.end());
  scan.notes.insert(scan.notes.end(), more.notes.begin(), more.notes.end());
}

}  // namespace hapsim
