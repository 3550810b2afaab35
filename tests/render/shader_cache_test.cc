#include "render/shader_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/full_disk.h"
#include "tests/temp_folder.h"

namespace kinescope::render {
namespace {

namespace fs = std::filesystem;

// Allocated, not only long.
std::uintmax_t BytesOnDisk(const fs::path& file) {
  struct stat status {};
  return ::stat(file.c_str(), &status) == 0 ? 512u * static_cast<std::uintmax_t>(status.st_blocks)
                                            : 0;
}

TEST(ShaderCache, AllBlocksOfItsIndexAreAllocated) {
  const testing::TempFolder cache;
  EXPECT_EQ(ReserveShaderIndex(cache / "mesa_shader_cache"), "");
  const fs::path index = cache / "mesa_shader_cache/index";
  EXPECT_EQ(fs::file_size(index), 1'310'728u) << "Mesa would change another size, with holes";
  EXPECT_GE(BytesOnDisk(index), 1'310'728u);
}

TEST(ShaderCache, TheHolesOfAnExistingIndexAreFilledAndItsContentStays) {
  const testing::TempFolder cache;
  const fs::path index = cache / "mesa_shader_cache/index";
  fs::create_directory(index.parent_path());
  std::ofstream(index) << "keys";
  fs::resize_file(index, 1'310'728);
  ASSERT_LT(BytesOnDisk(index), 100'000u);
  EXPECT_EQ(ReserveShaderIndex(index.parent_path()), "");
  EXPECT_GE(BytesOnDisk(index), 1'310'728u);
  std::string content(4, ' ');
  std::ifstream(index).read(content.data(), 4);
  EXPECT_EQ(content, "keys");
}

TEST(ShaderCache, AFullDiskIsNamedAndNothingIsLeftOnIt) {
  const testing::TempFolder cache;
  const testing::SmallFilesOnly full(100'000);
  EXPECT_EQ(ReserveShaderIndex(cache / "mesa_shader_cache"), "File too large");
  EXPECT_FALSE(fs::exists(cache / "mesa_shader_cache/index"));
}

TEST(ShaderCache, AMissingOrForeignFolderIsNotReserved) {
  const testing::TempFolder cache;
  EXPECT_EQ(ReserveShaderIndex("/proc/nowhere/mesa_shader_cache"), "No such file or directory");
  fs::create_directory(cache / "mesa_shader_cache");
  std::ofstream(cache / "other") << "not an index";
  fs::create_symlink(cache / "other", cache / "mesa_shader_cache/index");
  EXPECT_NE(ReserveShaderIndex(cache / "mesa_shader_cache"), "") << "followed a link";
  EXPECT_EQ(fs::file_size(cache / "other"), 12u);
}

}  // namespace
}  // namespace kinescope::render
