#include "mesh/window.h"

#include <sstream>

#include "io/number.h"

namespace hapsim {
namespace {

const std::string kKey = "window ";

}  // namespace

std::string window_comment(const std::vector<Vec3>& window) {
  std::string text = kKey.substr(0, kKey.size() - 1);
  for (const Vec3& p : window)
    for (int k = 0; k < 3; ++k) text += " " + format_number(p[k]);
  return text;
}

std::vector<Vec3> window_of(const std::vector<std::string>& comments, double factor) {
  for (const std::string& comment : comments) {
    if (!comment.starts_with(kKey)) continue;
    std::istringstream words(comment.substr(kKey.size()));
    std::vector<double> numbers;
    std::string word;
    double number = 0;
    while (words >> word) {
      if (!parse_number(word, number)) return {};
      numbers.push_back(factor * number);
    }
    std::vector<Vec3> window;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
      window.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return window.size() < 3 ? std::vector<Vec3>{} : window;
  }
  return {};
}

bool inside_window(const std::vector<Vec3>& window, const Vec3& p) {
  bool inside = false;
  for (std::size_t i = 0, j = window.size() - 1; i < window.size(); j = i++) {
    const Vec3 &a = window[i], &b = window[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

}  // namespace hapsim
