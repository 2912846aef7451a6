// replay CASES: every file below CASES/READER, and mutants of each, through its reader. What
// fuzzing has found stands among them. Memory is bounded, so a size that a header only claims
// shows.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fuzz/mutant.h"
#include "fuzz/readers.h"

namespace fs = std::filesystem;
using namespace hapsim;

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::fprintf(stderr, "usage: replay CASES [MUTANTS]\n");
    return 2;
  }
#if !defined(__SANITIZE_ADDRESS__)
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = 1UL << 30;
  setrlimit(RLIMIT_AS, &limit);
#endif
  const int mutants = argc == 3 ? std::atoi(argv[2]) : 200;
  Random random(7);
  for (const fuzz::Reader& reader : fuzz::readers()) {
    std::vector<fs::path> files;
    if (fs::is_directory(fs::path(argv[1]) / reader.name))
      for (const auto& entry : fs::directory_iterator(fs::path(argv[1]) / reader.name))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    if (files.empty()) {
      std::fprintf(stderr, "replay: there is no case for the reader %s\n", reader.name);
      return 1;
    }
    std::size_t accepted = 0, survived = 0;
    for (const fs::path& file : files) {
      std::ifstream in(file, std::ios::binary);
      std::ostringstream bytes;
      bytes << in.rdbuf();
      accepted += fuzz::read_or_refuse(reader, bytes.str()) ? 1 : 0;
      for (int k = 0; k < mutants; ++k)
        survived += fuzz::read_or_refuse(reader, fuzz::mutant(bytes.str(), random)) ? 1 : 0;
    }
    std::printf("%-10s %3zu cases, %3zu read; %8zu mutants, %8zu read\n", reader.name, files.size(),
                accepted, files.size() * static_cast<std::size_t>(mutants), survived);
  }
  return 0;
}
