#include "io/extension.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace hapsim {

std::string extension_of(const std::string& path) {
  std::string end = std::filesystem::path(path).extension().string();
  if (end.size() < 2) return "";
  end.erase(0, 1);
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  if (std::all_of(end.begin(), end.end(), is_digit)) return "";
  std::error_code none;
  const auto kind = std::filesystem::status(path, none).type();
  using Kind = std::filesystem::file_type;
  if (kind == Kind::character || kind == Kind::fifo || kind == Kind::socket || kind == Kind::block)
    return "";
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end;
}

}  // namespace hapsim
