#include "link/terms.h"

#include <fmt/format.h>

#include <cmath>

#include "link/bytes.h"

namespace hapsim {
namespace {

bool is_given(const Fingerprint& print) {
  return print != Fingerprint{};
}

std::string text_of(const std::array<char, 16>& units) {
  std::string text;
  for (const char c : units) {
    if (c == 0) break;
    text += c >= 0x20 && c < 0x7f ? c : '?';
  }
  return text;
}

std::string box_of(const Terms& terms) {
  const Vec3 size = 1e3 * (terms.high - terms.low);
  return fmt::format("{:.4g} x {:.4g} x {:.4g} mm", size.x(), size.y(), size.z());
}

}  // namespace

void Terms::write(unsigned char* at) const noexcept {
  put(at, version);
  put(at, std::uint32_t{0});
  put(at, units);
  put(at, tool_radius);
  put_vector(at, low);
  put_vector(at, high);
  put(at, body);
  put(at, model);
}

Terms Terms::read(const unsigned char* at) noexcept {
  Terms terms;
  terms.version = take<std::uint32_t>(at);
  take<std::uint32_t>(at);
  terms.units = take<std::array<char, 16>>(at);
  terms.tool_radius = take<double>(at);
  terms.low = take_vector(at);
  terms.high = take_vector(at);
  terms.body = take<Fingerprint>(at);
  terms.model = take<Fingerprint>(at);
  return terms;
}

Mismatch mismatch(const Terms& a, const Terms& b) noexcept {
  if (a.version != b.version) return Mismatch::kVersion;
  if (a.units != b.units) return Mismatch::kUnits;
  if (!(std::abs(a.tool_radius - b.tool_radius) <= 1e-6 * a.tool_radius)) return Mismatch::kTool;
  const double near = 0.1 * (a.high - a.low).norm();
  if (!((a.low - b.low).norm() <= near) || !((a.high - b.high).norm() <= near))
    return Mismatch::kBody;
  if (is_given(a.model) && is_given(b.model) && a.model != b.model) return Mismatch::kModel;
  return Mismatch::kNone;
}

std::string words_of(Mismatch mismatch, const Terms& here, const Terms& there) {
  switch (mismatch) {
    case Mismatch::kVersion:
      return fmt::format("its link has version {} and this one {}", there.version, here.version);
    case Mismatch::kUnits:
      return fmt::format("its units are {} and these {}", text_of(there.units),
                         text_of(here.units));
    case Mismatch::kTool:
      return fmt::format("its tool has a radius of {:.4g} mm and this one {:.4g} mm",
                         1e3 * there.tool_radius, 1e3 * here.tool_radius);
    case Mismatch::kBody:
      return "its body is another: a box of " + box_of(there) + " and not " + box_of(here) +
             ", or elsewhere";
    case Mismatch::kModel:
      return "its model is another than --expect-model";
    default:
      return "it does not say why";
  }
}

}  // namespace hapsim
