# Sourced by the tests of pages, after scratch.sh: a page in a browser, in a frame of a given size, with a script
# of ours in its head. Needs Chromium.
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || need chromium
tests_cli=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

# What a reader of the page does: probe.js, which calls say(NAME, VALUE) within its steps(); what it says stands
# behind "probe " in the page. hapsimBarriers() is there.
probed() { # PAGE PROBE: to probed.html
  {
    cat "$tests_cli/accessible.js"
    cat <<'JS'
window.hapsimErrors = [];
window.addEventListener("error", e => window.hapsimErrors.push(e.message));
window.addEventListener("load", () => setTimeout(() => {
  const lines = [], say = (name, value) => lines.push("probe " + name + "=" + value);
  try { steps(say); } catch (error) { window.hapsimErrors.push("probe: " + error.message); }
  scrollTo(0, 0);
  const barriers = hapsimBarriers();
  say("barriers", barriers.length + (barriers.length ? " " + barriers.slice(0, 8).join(" | ") : ""));
  say("width", document.documentElement.scrollWidth <= innerWidth);
  say("inner", innerWidth);
  say("errors", window.hapsimErrors.join(";"));
  const out = document.createElement("pre");
  out.textContent = lines.join("\n");
  parent.document.body.appendChild(out);
}, 100));
JS
    cat "$2"
  } >script.js
  awk 'NR == FNR { script = script $0 "\n"; next }
     { at = index($0, "<head>"); if (at) { print substr($0, 1, at + 5); printf "<script>%s</script>\n", script; print substr($0, at + 6) } else print }' \
    script.js "$1" >probed.html
  sed 's/&/\&amp;/g; s/"/\&quot;/g' probed.html >escaped
}
# As on a screen of that size: in a frame, for the browser's own window has a least width.
shown_at() { # WIDTH HEIGHT: to dom.html; the console is silent
  width=$1
  { printf '<!DOCTYPE html><body style="margin:0"><iframe style="border:0" width="%s" height="%s" srcdoc="' "$1" "$2"
    cat escaped
    printf '"></iframe></body>'; } >framed.html
  "$browser" --headless --no-sandbox --disable-gpu-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader \
    --hide-scrollbars --user-data-dir="$work/profile" --enable-logging=stderr --virtual-time-budget=5000 \
    --window-size=1300,1000 --dump-dom "file://$work/framed.html" >dom.html 2>browser.err ||
    complain 'the browser failed'
  seen inner "$1"
  seen width true
  seen barriers 0
  grep -q 'probe errors=' dom.html && ! grep -q 'probe errors=[^<]' dom.html || complain "errors: $(grep -o 'probe errors=[^<]*' dom.html)"
  grep CONSOLE browser.err && complain 'the console speaks'
}
seen() { # NAME VALUE
  grep -q "probe $1=$2\$" dom.html || grep -q "probe $1=$2<" dom.html ||
    complain "$width px: $1 is not $2: $(grep -o "probe $1=[^<]*" dom.html)"
}
