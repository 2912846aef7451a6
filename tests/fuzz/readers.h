// Every reader of files, called on bytes in memory.
#pragma once

#include <string>
#include <vector>

namespace hapsim::fuzz {

struct Reader {
  const char* name;  // also the folder of its cases
  void (*read)(const std::string& bytes);
};

const std::vector<Reader>& readers();

// Null when there is none of that name.
const Reader* find_reader(const std::string& name);

// Reads, and takes a refusal for an answer: an Error whose message is one line. Anything else that
// is thrown, and whatever a sanitizer sees, ends the process.
bool read_or_refuse(const Reader& reader, const std::string& bytes);

}  // namespace hapsim::fuzz
