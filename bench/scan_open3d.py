# scan_open3d.py IN.ply OUT.ply: Open3D's chain from points to a surface (outliers, normals, their orientation, Poisson), on one
# thread, with the settings of its tutorial. More than 200,000 points are merged to a millimetre first, without which they
# take it minutes. Prints how many points it kept and the processor seconds, without those of the import.
import sys
import time

import open3d

start = time.process_time()
points = open3d.io.read_point_cloud(sys.argv[1])
if len(points.points) > 200000:
    points = points.voxel_down_sample(0.001)
points, _ = points.remove_statistical_outlier(20, 2.0)
points.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(30))
points.orient_normals_consistent_tangent_plane(30)
mesh, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(points, depth=8, n_threads=1)
open3d.io.write_triangle_mesh(sys.argv[2], mesh)
print(len(points.points), time.process_time() - start)
