#include "simbody_chain.hpp"

#include <Simbody.h>

#include "chain_data.hpp"

namespace tenon::bench {

struct SimbodyChain::Model {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  SimTK::Force::Gravity gravity{forces, matter, SimTK::Vec3(0, 0, -9.81)};
  SimTK::State state;
  int bodies = 0;
};

SimbodyChain::SimbodyChain(int bodies) : model_(new Model) {
  const SimTK::Vec3 centre(0.5 * length, 0, 0);
  const SimTK::Body::Rigid link(
      SimTK::MassProperties(mass, centre, SimTK::Inertia(inertia).shiftFromMassCenter(centre, mass)));
  SimTK::MobilizedBody parent = model_->matter.Ground();
  for (int k = 0; k < bodies; ++k) {
    const SimTK::Rotation turn = k % 2 == 1 ? SimTK::Rotation(tilt, SimTK::XAxis) : SimTK::Rotation();
    parent = SimTK::MobilizedBody::Pin(parent, SimTK::Transform(turn, SimTK::Vec3(k > 0 ? length : 0.0, 0, 0)), link,
                                       SimTK::Transform(turn));
  }
  model_->bodies = bodies;
  model_->state = model_->system.realizeTopology();
}

SimbodyChain::~SimbodyChain() = default;

void SimbodyChain::run() {
  SimTK::Vector& q = model_->state.updQ();
  SimTK::Vector& u = model_->state.updU();
  for (int k = 0; k < model_->bodies; ++k) {
    q[k] = bend(k);
    u[k] = -bend(k);
  }
  model_->system.realize(model_->state, SimTK::Stage::Acceleration);
}

double SimbodyChain::acceleration(int k) const { return model_->state.getUDot()[k]; }

}  // namespace tenon::bench
