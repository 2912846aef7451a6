// Bytes as a file, for libraries that read nothing else.
#pragma once

#include <string>

#include "io/temp_files.h"

namespace hapsim {

class ScratchFile {
 public:
  // Error(kIo) names `target` when the folder of temporary files takes no more.
  ScratchFile(const std::string& bytes, const std::string& target);
  const std::string& path() const { return file_.path(); }

 private:
  TempFile file_;
};

}  // namespace hapsim
