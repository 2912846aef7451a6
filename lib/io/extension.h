// What the end of a file's name says about its format.
#pragma once

#include <string>

namespace hapsim {

// "stl" of "out.STL"; "" of a name without one, of "-", of a number at the end ("run.2"), and of
// what is there and no regular file: the name of a device or a named pipe says nothing.
std::string extension_of(const std::string& path);

}  // namespace hapsim
