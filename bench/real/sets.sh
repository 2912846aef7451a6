# What bench/real/run.sh runs: a line a set, NAME|RECIPE|TABLES below the folder of recordings|FLAGS of the first tool.
# What a recipe does stands in recipes.sh. Sizes that no table tells are stated here, as a user would state them.
sets() {
  cat <<'END'
liver-region1|organ|dvrk_liver/pig_liver_20150826_region1.csv|
liver-v2-region2|organ|dvrk_liver/pig_liver_20150826_v2_region2.csv|
robot-meat-region4|organ|dvrk_meat/meat0904_region4.csv|
phantom-whole|organ|phantom_balls/whole_region_model_v2.csv|
phantom-small-balls|organ|phantom_balls/region_small_balls.csv|
phantom-ral2018|organ|phantom_balls/probingRAL2018_T1.csv|
silicone-10|machine|silicone_compression/EF10_0T_A?.csv|--block 50x30mm --tool platen
silicone-30|machine|silicone_compression/EF30_0T_A?.csv|--block 50x30mm --tool platen
silicone-50|machine|silicone_compression/EF50_0T_A?.csv|--block 50x30mm --tool platen
silicone-10-50|machine|silicone_compression/EF10_50T_A?.csv|--block 50x30mm --tool platen
meat-one-place|machine|meat_zwick/meat_230515_P002_1?_trav.csv|--block 100x100x14mm --tool-radius 4mm
vhb-rates|machine|vhb_tension/0d0*.csv|--rate 5 --block 0.2x0.2x0.3m --tool-radius 20mm
vhb-step|machine|vhb_tension/single_step_3d0.csv|--rate 2 --block 0.2x0.2x0.3m --tool-radius 20mm
afm|machine|afm/afm_workshop_single.csv|--block 100x100x50um --tool sphere --tool-radius 5um --yes
kidney|surface|kidney_touch/kidney_explore_z1-4_every8th.csv|
bunny|points|scans/stanford-bunny.obj|
liver-mesh|mesh|scans/liver.msh|--unit cm --fixed below:0
liver-vtk|mesh|scans/liver.vtk|--unit mm
liver-obj|points|scans/liver.obj|--unit cm
END
}
