#include "server/app/html.h"

#include <gtest/gtest.h>

namespace kinescope::app {
namespace {

TEST(Html, EscapesNames) {
  EXPECT_EQ(EscapeHtml("Anna, 75 kg"), "Anna, 75 kg");
  EXPECT_EQ(EscapeHtml("<script>"), "&#60;script&#62;");
  EXPECT_EQ(EscapeHtml("a\"b'c&d"), "a&#34;b&#39;c&#38;d");
  EXPECT_EQ(EscapeHtml("é"), "&#233;");
  EXPECT_EQ(EscapeHtml("\xFF"), "&#65533;");
}

// The vectors of RFC 4648, section 10.
TEST(Html, EncodesBytesInBase64) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) {
    EXPECT_EQ(DataUrl("image/png", bytes), std::string("data:image/png;base64,") + text);
  }
}

}  // namespace
}  // namespace kinescope::app
