// libFuzzer on one reader, the one that the environment variable HAPSIM_READER names:
//   LSAN_OPTIONS=suppressions=tests/fuzz/leaks.supp HAPSIM_READER=ply \
//     fuzz_readers -max_total_time=60 -rss_limit_mb=1500 found tests/fuzz/cases/ply
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/readers.h"

using namespace hapsim::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Reader* const reader = [] {
    const char* name = std::getenv("HAPSIM_READER");
    const Reader* found = name == nullptr ? nullptr : find_reader(name);
    if (found == nullptr) {
      std::fprintf(stderr, "HAPSIM_READER must be one of:");
      for (const Reader& r : readers()) std::fprintf(stderr, " %s", r.name);
      std::fprintf(stderr, "\n");
      std::exit(2);
    }
    return found;
  }();
  read_or_refuse(*reader, std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
