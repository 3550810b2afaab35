#include "core/system/sha256.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/system/errors.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

// FIPS 180-4's examples, and a file of several blocks.
TEST(DigestOf, EqualsTheExamplesOfTheStandard) {
  const testing::TempFolder folder;
  const auto digest = [&](const std::string& content) {
    std::ofstream(folder / "file", std::ios::binary) << content;
    return DigestOf(folder / "file");
  };
  EXPECT_EQ(digest("").sha256, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digest("abc").sha256,
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const FileDigest million = digest(std::string(1'000'000, 'a'));
  EXPECT_EQ(million.sha256, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(million.bytes, 1'000'000u);
}

TEST(DigestOf, NamesAFileThatIsNotReadable) {
  for (const char* path : {"/nowhere/file", "/"}) {
    try {
      DigestOf(path);
      FAIL() << path;
    } catch (const SourceError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(path));
    }
  }
}

}  // namespace
}  // namespace kinescope
