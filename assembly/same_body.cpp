#include "assembly/same_body.hpp"

#include <fmt/format.h>

#include <type_traits>

namespace tenon::assembly {
namespace {

/// Writes values one after the other, numbers with all their bits.
class Text {
 public:
  template <class... Values>
  Text& operator()(const Values&... values) {
    (add(values), ...);
    return *this;
  }
  std::string text;

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void add(Number value) {
    if constexpr (std::is_enum_v<Number>)
      text += fmt::format("{};", static_cast<int>(value));
    else if constexpr (std::is_floating_point_v<Number>)
      text += fmt::format("{:a};", value);
    else
      text += fmt::format("{};", value);
  }
  void add(const std::string& word) { text += fmt::format("{}:{};", word.size(), word); }
  void add(const std::filesystem::path& path) { add(path.lexically_normal().string()); }
  void add(const Vec3& v) { (*this)(v.x(), v.y(), v.z()); }
  void add(const Mat3& m) { (*this)(Vec3(m.col(0)), Vec3(m.col(1)), Vec3(m.col(2))); }
  template <class Value>
  void add(const std::optional<Value>& value) {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    (*this)(values.size());
    for (const Value& value : values) (*this)(value);
  }

  void add(const Units& u) { (*this)(u.length, u.mass, u.time, u.force); }
  void add(const fem::Material& m) { (*this)(m.E, m.G, m.nu, m.rho); }
  void add(const fem::BeamSection& s) { (*this)(s.A, s.Iy, s.Iz, s.Iyz, s.J, s.kappa_y, s.kappa_z, s.nsm); }
  void add(const fem::Ply& p) { (*this)(p.thickness, p.angle, p.E1, p.E2, p.nu12, p.G12, p.G13, p.G23, p.rho); }
  void add(const fem::ShellSection& s) { (*this)(s.thickness, s.nsm, s.bending_ratio, s.shear_ratio, s.plies); }
  void add(const NodeSelector& n) { (*this)(n.kind, n.point, n.centre, n.node, n.name); }
  void add(const ScenePort& p) { (*this)(p.name, p.where, p.average, p.axes); }
  void add(const SceneSection& s) {
    (*this)(s.set, s.shape.index(), s.material, s.orientation, s.rod, s.rotary_inertia, s.offset, s.normal_offset);
    std::visit([this](const auto& shape) { (*this)(shape); }, s.shape);
    (*this)(s.along.has_value(), s.taper != nullptr);
    if (s.along) (*this)((*s.along)[0], (*s.along)[1]);
    if (s.taper) (*this)(s.taper(0.0), s.taper(0.5), s.taper(1.0));
  }
  void add(const SceneSet& s) { (*this)(s.name); }
  void add(const SceneSupport& s) { (*this)(s.set, s.directions); }
  void add(const SceneNodeMass& m) { (*this)(m.where, m.mass, m.inertia, m.offset); }
  void add(const SceneSpring& s) {
    (*this)(s.from, s.to, s.axes, s.at);
    for (const double k : s.k) (*this)(k);
  }
  void add(const MatrixFiles& m) { (*this)(m.program, m.K, m.M, m.labels, m.job, m.deck); }
  void add(const FeSource& fe) {
    (*this)(fe.file, fe.matrices, fe.units, fe.sections, fe.supports, fe.masses, fe.springs, fe.beam_mass, fe.ignore,
            fe.allow);
  }
  void add(const ReducedSource& reduced) { (*this)(reduced.file); }
  void add(const BeamSource& b) { (*this)(b.model, b.from, b.to, b.section, b.elements, b.modes, b.planar); }
  void add(const RigidSource&) {}
  void add(const reduction::ReduceOptions& o) {
    (*this)(o.basis, o.modes, o.band, o.all_modes, o.zeta, o.keep_shapes, o.nonlinear);
  }
};

}  // namespace

std::string fingerprint(const SceneBody& body, const BodyPlan& plan) {
  if (std::holds_alternative<RigidSource>(body.source)) return {};
  Text text;
  text(body.source.index());
  std::visit([&](const auto& source) { text(source); }, body.source);
  text(body.ports, body.parent_port, body.damping, plan.rigid, plan.options);
  return text.text;
}

}  // namespace tenon::assembly
