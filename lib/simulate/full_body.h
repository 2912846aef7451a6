// What a model makes of a body of finite elements: its laws, mixtures, springs and memory.
#pragma once

#include <memory>
#include <vector>

#include "contact/contact_stiffness.h"
#include "effects/effect.h"
#include "experiment/forces.h"
#include "model/relaxation_steps.h"
#include "nonlinear/tool_body.h"
#include "simulate/full_simulation.h"

namespace hapsim {

class FullBody {
 public:
  // `body` must outlive it. Error(kBadInput): an effect that has no such form (Effect::full()),
  // a body that is moved, contacts that feel their own region alone.
  FullBody(const TetMesh& body, const Model& model, const FullOptions& options);

  // Of the body's own mesh or one of a contact, where an element at the boundary of a label is of
  // the mixture of its moduli. `free_base`: it stands on springs.
  BodyModel model(const TetMesh& mesh, bool& free_base) const;
  std::vector<std::vector<Relaxation>> relaxation() const;  // a list a region, as the laws are
  const MaterialSpec& material() const { return material_; }
  const FullSpec& spec() const { return spec_; }
  const std::vector<EffectInstance>& around() const { return around_; }
  const ContactBase& base() const { return base_; }

 private:
  void place_regions(const TetMesh& mesh, BodyModel& model) const;

  const TetMesh& body_;
  bool averaged_;
  MaterialSpec material_;
  std::vector<RegionRelaxation> regions_;  // where they relax each in its own way
  FullSpec spec_;
  std::vector<EffectInstance> around_;  // effects on the motion and of the sensor
  ContactBase base_;
  std::shared_ptr<const SurfaceTree> surface_;
  std::shared_ptr<const BodyRegions> labels_;  // where they act
};

}  // namespace hapsim
