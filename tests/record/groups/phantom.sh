# The main job (Makefile.pipeline) on the shipped phantom with its hidden effect and without, and on its body and
# models what the other tools make of them: formats, exports, streams, regions, libraries, checks.
use phantom "$examples/phantom"
job="make -s -f '$root/Makefile.pipeline' EXAMPLE=phantom"
step report "$job OUT=data report"
step auto "$job OUT=data auto"
step plain "$job OUT=plain DATA=phantom/plain.csv report auto"
step diagnosis 'hs-diagnose phantom/data.csv --body data/body.ply --model data/m0.csv --json d0.json --junit d0.xml --plan plan.csv -o d0.csv'
step figures 'hs-compare phantom/data.csv --simulated data/f1.csv --body data/body.ply --model data/m1.csv --figures figure- --junit compare.xml --fail-above 1.5noise -o residuals.csv'
step check 'hs-check data/auto.csv --golden data/m1.csv --junit check.xml -o check.csv'
step profile 'hs-identify phantom/data.csv --body data/body.ply --model data/m1.csv --profile -o profile.csv
  hs-identify phantom/data.csv --body data/body.ply --model data/m1.csv --robust huber -o robust.csv'
step terms 'hs-identify phantom/data.csv --body data/body.ply --add viscoelastic --terms auto -o terms.csv'
step locations 'hs-identify phantom/plain.csv --body data/body.ply --folds 0 --locations locations.csv -o fit.csv'
step cluster 'hs-cluster locations.csv --boundary boundary.csv --dendrogram tree.csv --svg tree.svg --write-model clusters.csv -o classified.csv
  hs-cluster locations.csv --regions 2 --linkage complete --features E -o two.csv'

# Every format that a mesh is written in, and read back as a mesh and as a body.
step formats 'hs-tetmesh data/surface.ply --edge 0.015 --order 1 --vtu mesh.vtu --gmsh mesh.msh --inp mesh.inp --tetgen mesh --json mesh.json -o mesh.ply
  hs-tetmesh data/surface.ply --edge 0.015 --order 2 --gmsh-version 4.1 --gmsh mesh4.msh --ascii -o mesh2.ply
  for file in mesh.vtu mesh.msh mesh.inp mesh.node mesh4.msh mesh2.ply; do
    hs-tetmesh $file --ascii -o back-$file.ply || true
    hs-simulate phantom/plain.csv --body $file --model plain/m0.csv --own-mesh -o forces-$file.csv || true
  done'
step export 'for format in calculix febio sofa vtu gmsh; do
    hs-export data/m0.csv --format $format --body mesh.ply --data phantom/data.csv -o export.$format
    hs-tetmesh export.$format --ascii -o back-$format.ply
  done
  hs-export data/m1.csv --format febio --body mesh.ply --data phantom/data.csv -o relaxing.feb'
step full "awk -F, '/^#/ || !n++ || \$1 == 30 && \$12 && \$2 > last + 0.1 { print; last = \$2 }' phantom/data.csv >press.csv
  hs-simulate press.csv --body data/body.ply --model data/m1.csv --full --own-mesh -o full.csv
  hs-simulate press.csv --body mesh.ply --model plain/m0.csv --own-mesh --vtu field --rows 5 -o own.csv"

# Streams whose answers do not depend on the clock, the analytical model and the library.
step live 'hs-simulate --live phantom/data.csv --body data/body.ply --model data/m1.csv -o live.csv
  hs-identify --follow phantom/plain.csv --body data/body.ply --every 400 -o estimates.csv
  hs-compare --follow phantom/data.csv --body data/body.ply --model data/m1.csv --rate 50 --learning 10 --events events.csv -o followed.csv'
step acfm 'hs-identify phantom/data.csv --body data/body.ply --acfm 2 --folds 0 -o acfm.csv
  hs-simulate phantom/data.csv --model acfm.csv -o acfm-forces.csv'
step library 'rm -f lab.db
  hs-identify phantom/plain.csv --body data/body.ply --library lab.db --material foam --folds 0 -o stored.csv
  hs-identify phantom/data.csv --body data/body.ply --library lab.db --material foam --add viscoelastic --folds 0 -o nearest.csv
  hs-library lab.db | cut -d, -f1,3- >list.csv  # without the day
  hs-library lab.db --show 2 | grep -v "^# stored" >shown.csv
  rm lab.db'
