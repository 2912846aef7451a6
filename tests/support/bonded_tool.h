// A contact mesh whose patch is one handle: what a bonded tool moves, at any law.
#pragma once

#include <utility>
#include <vector>

#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim::test {

struct BondedTool {
  ContactMesh contact;
  std::vector<int> handle;
  explicit BondedTool(ContactMesh made)
      : contact(std::move(made)), handle(contact.mesh.nodes.size(), kFreeNode) {
    for (std::size_t n = 0; n < handle.size(); ++n)
      if (contact.mesh.fixed[n]) handle[n] = kHeldNode;
    for (const int n : contact.patch_nodes) handle[n] = 0;
  }
  NonlinearBody body(const LawPointer& law) const {
    BodyModel model{&contact.mesh, {law}};
    model.dilatation = Dilatation::kElement;
    return {model, handle};
  }
};

}  // namespace hapsim::test
