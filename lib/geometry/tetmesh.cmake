# Tetrahedra: meshing, support, quality, files.
target_sources(hapsim_geometry_cgal PRIVATE self_intersection.cpp)
target_sources(hapsim_geometry PRIVATE
  body_mesh.cpp
  quality.cpp
  signed_distance.cpp
  support.cpp
  tetgen.cpp
  tetgen_check.cpp
  tetgen_child.cpp
  tetmesh.cpp
  tetmesh_io.cpp
  three_nodes.cpp
  tool_contact.cpp)
