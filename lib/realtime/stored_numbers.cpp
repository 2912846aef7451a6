#include "realtime/stored_numbers.h"

#include <cstring>

#include "contact/contact_cache.h"

namespace hapsim {

std::string stored_numbers(const std::string& kind, const std::vector<double>& numbers) {
  std::string text = kind;
  text.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
  ContentHash sum;
  sum.add(text);
  return text + sum.hex();
}

std::optional<std::vector<double>> read_numbers(const std::string& kind, const std::string& bytes) {
  constexpr std::size_t kSum = 32;
  if (bytes.size() < kind.size() + kSum) return std::nullopt;
  const std::size_t end = bytes.size() - kSum;
  ContentHash sum;
  sum.add(bytes.substr(0, end));
  if (sum.hex() != bytes.substr(end) || bytes.compare(0, kind.size(), kind) != 0 ||
      (end - kind.size()) % sizeof(double) != 0)
    return std::nullopt;
  std::vector<double> numbers((end - kind.size()) / sizeof(double));
  std::memcpy(numbers.data(), bytes.data() + kind.size(), end - kind.size());
  return numbers;
}

}  // namespace hapsim
