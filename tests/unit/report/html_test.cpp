#include "report/html.h"

#include <gtest/gtest.h>

namespace hapsim {
namespace {

TEST(Html, EscapesWhatCouldBecomeMarkup) {
  EXPECT_EQ(escape_html("<a href=\"x\" id='y'>&"),
            "&lt;a href=&quot;x&quot; id=&#39;y&#39;&gt;&amp;");
  EXPECT_EQ(escape_html("a\nb\x01"), "a b ");
}

TEST(Html, KeepsUtf8AndReplacesOtherBytes) {
  EXPECT_EQ(escape_html("\xc2\xb5m \xe2\x88\x92"), "\xc2\xb5m \xe2\x88\x92");
  EXPECT_EQ(escape_html("a\xff"), "a\xef\xbf\xbd");
  EXPECT_EQ(escape_html("\xe2\x88"), "\xef\xbf\xbd\xef\xbf\xbd");
}

TEST(Html, ScriptStringsCannotEndTheScript) {
  EXPECT_EQ(script_string("</script>\"\\\n"), "\"\\u003c/script>\\\"\\\\ \"");
}

}  // namespace
}  // namespace hapsim
