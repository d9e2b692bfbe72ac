#pragma once

#include "assembly/scene.hpp"
#include "assembly/scene/document.hpp"

/// The readers of a scene, one for each part of the grammar; the document is validated before they see it.
namespace tenon::assembly {

/// Materials by name: those of the scene first, then the shipped ones (values in docs/scene.md).
class Materials {
 public:
  Materials(const Value* table, const Units& units);
  /// A material of the table by name, or one written in place.
  fem::Material read(const Value& value) const;

 private:
  Units units_;
  std::vector<fem::Material> known_;
};

SceneSection read_section(const Member& entry, const Value* body_material, const Materials& materials,
                          const Units& units);
BeamSource read_beam(const Value& map, const Materials& materials, const Units& units);
SceneBody read_body(const Member& entry, const std::filesystem::path& folder, const Materials& materials,
                    const Units& units);
Units read_units(const Value& document, const std::filesystem::path& file);

/// "body.port" with both known to the scene (ports of a reduced body stand in its file and are checked when it is
/// read).
SceneTarget read_port_target(const Value& value, const Scene& scene);

/// Joints, masses, ground, inputs and outputs, into a scene whose bodies are read.
void read_connections(const Value& document, Scene& scene);

/// Names are one word without a dot. Throws InputError.
void check_name(const Member& entry);

}  // namespace tenon::assembly
