# tool-list.sh BIN TOOL...: the table that hs is built with.
set -e
bin=$1
shift
for tool; do "$bin/$tool" --about; done
