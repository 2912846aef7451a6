// One place of a body at which a tool cannot press, where others are sound.
#pragma once

#include "base/error.h"

namespace hapsim {

// What make_contact_mesh() throws where the tool's disc does not fit on the body: at its border,
// over what is bonded, or where no mesh can be made.
class ContactUnfit : public Error {
 public:
  using Error::Error;
};

}  // namespace hapsim
