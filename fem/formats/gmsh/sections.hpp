#pragma once

#include "fem/formats/gmsh/content.hpp"
#include "fem/formats/gmsh/cursor.hpp"

/// Readers of the sections of .msh files. Each starts behind the section's first line and stops before its $End line;
/// all throw InputError with the place of the fault.
namespace tenon::fem::gmsh {

/// $MeshFormat: version, text or binary, sizes and byte order, kept in the cursor and the content.
void read_format(Cursor& cursor, Content& content);
/// $PhysicalNames.
void read_physical_names(Cursor& cursor, Content& content);
/// $Entities and $PartitionedEntities (4.x): which physical groups each entity of the geometry is in.
void read_entities(Cursor& cursor, Content& content);
void read_partitioned_entities(Cursor& cursor, Content& content);
/// $Nodes, or $ParametricNodes of 2.x files.
void read_nodes(Cursor& cursor, Content& content, bool parametric);
/// $Elements.
void read_elements(Cursor& cursor, Content& content);
/// $NodeData or $ElementData.
void read_field(Cursor& cursor, Content& content, bool on_nodes);

}  // namespace tenon::fem::gmsh
