# Tetrahedra: meshing, support, quality, files.
target_sources(hapsim_geometry_cgal PRIVATE self_intersection.cpp)
target_sources(hapsim_geometry PRIVATE
  body_mesh.cpp
  body_input.cpp
  curve_edges.cpp
  inner_regions.cpp
  insert_points.cpp
  mesh_abaqus.cpp mesh_abaqus_read.cpp
  mesh_febio.cpp
  mesh_file.cpp
  mesh_gmsh_read.cpp
  mesh_gmsh_write.cpp
  mesh_ply.cpp
  mesh_sofa.cpp
  mesh_tetgen_files.cpp
  mesh_vtu.cpp
  mesh_xml.cpp
  quality.cpp
  signed_distance.cpp
  support.cpp
  tetgen.cpp
  tetgen_check.cpp
  tetgen_child.cpp
  tetmesh.cpp
  text_scanner.cpp
  tetmesh_io.cpp
  three_nodes.cpp
  tool_contact.cpp)
