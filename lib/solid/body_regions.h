// The regions of a body as its tetrahedra are numbered, for meshes that do not follow them.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "mesh/surface_tree.h"
#include "mesh/tet_tree.h"
#include "mesh/tetmesh.h"
#include "solid/level_set.h"

namespace hapsim {

// Of every region the closed surface that bounds it: the faces between tetrahedra of different
// numbers. The body's own surface is no boundary: a region that reaches it goes on beyond, so that
// a mesh whose surface lies a little outside of the body's loses nothing of it. Several may touch,
// lie within one another or be in parts. Queries are thread-safe.
class BodyRegions {
 public:
  // Null where all tetrahedra have the number 0.
  static std::shared_ptr<const BodyRegions> of(const TetMesh& body);
  // A mesh without numbers is of region 0.
  explicit BodyRegions(const TetMesh& body);

  const std::vector<int>& numbers() const { return numbers_; }  // ascending
  // One of numbers() whose boundary has moved outwards, along its normals, by so much [m].
  struct Growth {
    int region = 0;
    double by = 0;
  };
  // Of the tetrahedron that holds the point [m], or, outside, whose boundary face is nearest.
  int at(const Vec3& p) const;
  int at(const Vec3& p, const std::vector<Growth>& growth) const;

  struct Part {
    int region = 0;
    double share = 0;               // of the volume
    std::vector<double> by_growth;  // its derivative by each growth [1/m]
  };
  // Of one tetrahedron of any mesh (straight between its corners), by region; shares above 0, or
  // with a derivative, that sum to 1. Near a boundary it is cut as by inside_share(), into 64 parts
  // in each of which the distance to each region's boundary is linear, and the shares of those
  // there are scaled to 1; into up to 64 times as many where something thinner passes between. What
  // grows takes from its neighbours, of two that grow into each other the one of the higher number.
  std::vector<Part> parts(const TetMesh& mesh, std::size_t tetrahedron,
                          const std::vector<Growth>& growth = {}) const;

  // How the boundaries lie that are nearest to a tetrahedron's corners and middle, as none has
  // grown: principal directions of their unit normals n (eigenvectors of the mean of n n'), each
  // with its weight, which sum to 1.
  std::vector<std::pair<Vec3, double>> across(const TetMesh& mesh, std::size_t tetrahedron) const;

  // The boundaries as closed outward surfaces, each between two regions, where all of them are such
  // and clear of the body's own surface; else none.
  std::vector<Surface> enclosed() const;

  // Distance to a region's boundary, negative inside; no parameters. Refers to this.
  LevelSet level(int region) const;

 private:
  struct Corner;
  Corner corner(const Vec3& p) const;
  double distance(const Corner& corner, int region) const;
  struct Cut;  // of a tetrahedron: what grows, and its parts so far
  void add_part(const std::array<const Corner*, 4>& x, int subdivisions, double weight,
                Cut& cut) const;
  void add_leaf(const std::array<const Corner*, 4>& x, double weight, Cut& cut) const;

  std::vector<int> numbers_, region_;  // region_: by tetrahedron
  TetTree tets_;
  std::unique_ptr<SurfaceTree> outside_;            // the body's surface
  std::vector<int> region_of_face_;                 // of it
  std::unique_ptr<SurfaceTree> between_;            // all boundaries
  std::vector<std::pair<int, int>> sides_;          // of each of its faces, the regions
  std::map<int, std::unique_ptr<SurfaceTree>> of_;  // each region's own, where there are three
};

}  // namespace hapsim
