# The thesis's experiments but telepresence, whose results depend on the clock. Rows of their summaries that are
# durations ([ms]) are taken out.
for experiment in virtual-reality meshes polyurethane two-regions heart; do
  step $experiment "make -s -f '$examples/thesis/Makefile' OUT=. $experiment
    sed -i '/\[ms\],/d' $experiment/summary.csv"
done
