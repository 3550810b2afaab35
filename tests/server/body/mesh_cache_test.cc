#include "server/body/mesh_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <future>
#include <iterator>
#include <map>
#include <new>
#include <thread>

#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uintmax_t kSetBytes = 1000;

std::vector<MeshFile> OneFile() { return {{"hand.stl", std::string(kSetBytes, 'x')}}; }

std::string NameOf(int number) { return "body-" + std::to_string(number); }

class MeshCacheTest : public ::testing::Test {
 protected:
  std::shared_ptr<const MeshFiles> Set(const std::string& name, const MeshCache& cache) {
    return cache.Files(name, [this] {
      ++made_;
      return OneFile();
    });
  }
  std::string Read(const std::string& name) const {
    std::ifstream file(folder_ / name / "hand.stl", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // As if it was last used so long ago.
  void Age(const std::string& name, int hours) const {
    fs::last_write_time(folder_ / name / "lock",
                        fs::file_time_type::clock::now() - std::chrono::hours(hours));
  }

  const testing::TempFolder folder_;
  int made_ = 0;
};

TEST_F(MeshCacheTest, WritesNothingBeforeFilesAreRequested) {
  const MeshCache cache(folder_.path());
  const auto files = Set("body-1", cache);
  EXPECT_EQ(cache.FolderOf("body-1"), folder_ / "body-1");
  EXPECT_THAT(folder_.Names(), IsEmpty());
  EXPECT_TRUE(files->Provide());
  EXPECT_EQ(Read("body-1"), std::string(kSetBytes, 'x'));
}

TEST_F(MeshCacheTest, WritesASetOnce) {
  const MeshCache cache(folder_.path()), of_another_process(folder_.path());
  const auto files = Set("body-1", cache);
  EXPECT_TRUE(files->Provide());
  EXPECT_TRUE(files->Provide());
  EXPECT_TRUE(Set("body-1", of_another_process)->Provide());
  EXPECT_EQ(made_, 1);
  EXPECT_THAT(folder_.Names(), ElementsAre("body-1")) << "nothing unfinished is left";
}

TEST_F(MeshCacheTest, WritesASetAgainThatTheUserHasRemoved) {
  const MeshCache cache(folder_.path());
  const auto files = Set("body-1", cache);
  EXPECT_TRUE(files->Provide());
  fs::remove_all(folder_ / "body-1");
  EXPECT_TRUE(files->Provide());
  EXPECT_EQ(Read("body-1").size(), kSetBytes);
}

// A sender whose scale data change with every message.
TEST_F(MeshCacheTest, KeepsItsLimitWithAThousandBodies) {
  const MeshCache cache(folder_.path(), 10 * kSetBytes);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(Set(NameOf(i), cache)->Provide());
  EXPECT_LE(folder_.Names().size(), 10U);
  EXPECT_THAT(folder_.Names(), Contains(NameOf(999)));
}

TEST_F(MeshCacheTest, RemovesTheLeastRecentlyUsedSetFirst) {
  const MeshCache cache(folder_.path(), 3 * kSetBytes);
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(Set(NameOf(i), cache)->Provide());
    Age(NameOf(i), 10 - i);
  }
  ASSERT_TRUE(Set("body-1", cache)->Provide()) << "used once more";
  ASSERT_TRUE(Set("body-4", cache)->Provide());
  EXPECT_THAT(folder_.Names(), ElementsAre("body-1", "body-3", "body-4"));
}

TEST_F(MeshCacheTest, KeepsTheMeshesOfACurrentModel) {
  const MeshCache cache(folder_.path(), 2 * kSetBytes);
  auto current = Set("body-current", cache);
  ASSERT_TRUE(current->Provide());
  Age("body-current", 100);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(Set(NameOf(i), cache)->Provide());
  EXPECT_THAT(folder_.Names(), Contains("body-current"));
  current.reset();
  ASSERT_TRUE(Set("body-last", cache)->Provide());
  EXPECT_THAT(folder_.Names(), ::testing::Not(Contains("body-current"))) << "no longer in use";
}

TEST_F(MeshCacheTest, KeepsTheMeshesThatAnotherProcessUses) {
  int ready[2], done[2];
  ASSERT_EQ(pipe(ready) + pipe(done), 0);
  const pid_t other = fork();
  if (other == 0) {
    const MeshCache cache(folder_.path(), kSetBytes);
    const auto files = Set("body-other", cache);
    char byte = files->Provide() ? 1 : 0;
    Age("body-other", 100);
    const bool told = write(ready[1], &byte, 1) == 1 && read(done[0], &byte, 1) == 1;
    _exit(told ? 0 : 1);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  ASSERT_EQ(byte, 1);
  const MeshCache cache(folder_.path(), kSetBytes);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(Set(NameOf(i), cache)->Provide());
  EXPECT_THAT(folder_.Names(), Contains("body-other"));
  ASSERT_EQ(write(done[1], &byte, 1), 1);
  int status = 0;
  ASSERT_EQ(waitpid(other, &status, 0), other);
  EXPECT_EQ(status, 0);
  ASSERT_TRUE(Set("body-last", cache)->Provide());
  EXPECT_THAT(folder_.Names(), ElementsAre("body-last")) << "a process that ended uses nothing";
  for (const int end : {ready[0], ready[1], done[0], done[1]}) close(end);
}

TEST_F(MeshCacheTest, RemovesFilesOfEarlierVersionsAndCrashedProcesses) {
  for (const char* left : {"figure-0123", "body-1.new-77-0", "body-2.old-77"}) {
    fs::create_directory(folder_ / left);
    std::ofstream(folder_ / left / "hand.stl") << std::string(kSetBytes, 'x');
    fs::last_write_time(folder_ / left, fs::file_time_type::clock::now() - std::chrono::hours(2));
  }
  std::ofstream(folder_ / "other.txt") << "not a mesh";
  const MeshCache cache(folder_.path(), kSetBytes);
  ASSERT_TRUE(Set("body-3", cache)->Provide());
  EXPECT_THAT(folder_.Names(), ElementsAre("body-3", "other.txt"));
}

TEST_F(MeshCacheTest, IsUsedByManyThreadsAtOnce) {
  const MeshCache cache(folder_.path(), 2 * kSetBytes);
  std::vector<std::thread> threads;
  std::atomic<int> provided{0};
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&cache, &provided, thread] {
      for (int i = 0; i < 50; ++i) {
        const auto files = cache.Files(NameOf((i + thread) % 5), OneFile);
        provided += files->Provide() ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(provided, 200);
}

TEST_F(MeshCacheTest, ReportsFailureIfItCannotWrite) {
  const MeshCache cache(folder_.path());
  std::ofstream(folder_ / "body-1") << "a file where the folder has to be";
  EXPECT_FALSE(Set("body-1", cache)->Provide());
}

TEST_F(MeshCacheTest, KeepsItsNumberOfSetsWithAHundredSmallBodies) {
  const MeshCache cache(folder_.path(), MeshCache::kDefaultLimit, 10);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(Set(NameOf(i), cache)->Provide());
  EXPECT_LE(folder_.Names().size(), 10U);
  EXPECT_THAT(folder_.Names(), Contains(NameOf(99)));
}

TEST_F(MeshCacheTest, TheContentOfASetIsMadeOnceAndWritesNothing) {
  const MeshCache cache(folder_.path());
  const auto files = Set("body-1", cache);
  ASSERT_NE(files->Content("hand.stl"), nullptr);
  EXPECT_EQ(*files->Content("hand.stl"), std::string(kSetBytes, 'x'));
  EXPECT_EQ(files->Content("foot.stl"), nullptr);
  EXPECT_EQ(files->Content("../body-1/hand.stl"), nullptr);
  EXPECT_EQ(made_, 1);
  EXPECT_THAT(folder_.Names(), IsEmpty());
}

TEST_F(MeshCacheTest, TheContentsOfACrowdStayInMemory) {
  const MeshCache cache(folder_.path());
  constexpr int kPeople = 20;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < kPeople; ++i) EXPECT_TRUE(Set(NameOf(i), cache)->Content("hand.stl"));
  }
  EXPECT_EQ(made_, kPeople);
}

TEST_F(MeshCacheTest, TheContentsThatWereUsedLastStayInMemory) {
  const MeshCache cache(folder_.path());
  std::weak_ptr<const std::string> once = Set("body-once", cache)->Content("hand.stl");
  EXPECT_FALSE(once.expired());
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(Set(NameOf(i), cache)->Content("hand.stl"));
    EXPECT_TRUE(Set("body-always", cache)->Content("hand.stl"));
  }
  EXPECT_EQ(made_, 1 + 100 + 1);
  EXPECT_TRUE(once.expired());
}

TEST_F(MeshCacheTest, TheContentsInMemoryAreLimitedInBytes) {
  const MeshCache cache(folder_.path());
  const auto content_of = [&](int number) {
    const auto large = [] {
      return std::vector<MeshFile>{{"hand.stl", std::string(15'000'000, 'x')}};
    };
    return cache.Files(NameOf(number), large)->Content("hand.stl");
  };
  const std::weak_ptr<const std::string> first = content_of(1), second = content_of(2);
  EXPECT_FALSE(first.expired());
  EXPECT_TRUE(content_of(3));
  EXPECT_TRUE(first.expired());
  EXPECT_FALSE(second.expired());
}

// The page answers nobody while it waits.
TEST_F(MeshCacheTest, TheContentOfASetDoesNotWaitForThatOfAnother) {
  const MeshCache cache(folder_.path());
  std::promise<void> slow_has_begun, fast_is_there;
  bool was_fast = false;
  std::thread slow([&] {
    const auto files = cache.Files("body-slow", [&] {
      slow_has_begun.set_value();
      const auto status = fast_is_there.get_future().wait_for(std::chrono::seconds(10));
      was_fast = status == std::future_status::ready;
      return OneFile();
    });
    EXPECT_TRUE(files->Content("hand.stl"));
  });
  slow_has_begun.get_future().wait();
  EXPECT_TRUE(Set("body-fast", cache)->Content("hand.stl"));
  fast_is_there.set_value();
  slow.join();
  EXPECT_TRUE(was_fast);
}

TEST_F(MeshCacheTest, AContentIsMadeOnceForSeveralThreads) {
  const MeshCache cache(folder_.path());
  std::atomic<int> made{0};
  const auto files = cache.Files("body-1", [&] {
    ++made;
    return OneFile();
  });
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] { EXPECT_TRUE(files->Content("hand.stl")); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 1);
}

TEST_F(MeshCacheTest, AContentThatCannotBeMadeIsTriedAgain) {
  const MeshCache cache(folder_.path());
  int tries = 0;
  const auto files = cache.Files("body-1", [&] {
    if (++tries == 1) throw std::bad_alloc();
    return OneFile();
  });
  EXPECT_EQ(files->Content("hand.stl"), nullptr);
  EXPECT_NE(files->Content("hand.stl"), nullptr);
}

TEST_F(MeshCacheTest, ACacheInMemoryHasContentAndNoFiles) {
  const auto cache = MeshCache::InMemory();
  const auto files = Set("body-1", *cache);
  EXPECT_TRUE(files->Content("hand.stl"));
  EXPECT_FALSE(files->Provide());
  EXPECT_FALSE(fs::exists(cache->FolderOf("body-1")));
}

// The folders of a user, below one of the test.
class FolderOfUser : public MeshCacheTest {
 protected:
  FolderOfUser() {
    for (const char* name : kVariables) {
      if (const char* value = std::getenv(name)) before_[name] = value;
      unsetenv(name);
    }
    setenv("TMPDIR", Made("tmp").c_str(), 1);
  }
  ~FolderOfUser() override {
    for (const char* name : kVariables) unsetenv(name);
    for (const auto& [name, value] : before_) setenv(name.c_str(), value.c_str(), 1);
  }

  std::string Made(const std::string& name) const {
    fs::create_directory(folder_ / name);
    return folder_ / name;
  }
  // Where it keeps the sets, below the folder of the test; "" for nowhere.
  std::string Chosen(MeshCache::Lifetime lifetime = MeshCache::Lifetime::kProcess) {
    const auto cache = MeshCache::OfUser(lifetime);
    if (cache == nullptr) return "";
    const fs::path root = cache->FolderOf("body-1").parent_path();
    permissions_ = fs::status(root).permissions();
    return root.lexically_relative(folder_.path());
  }

  fs::perms permissions_ = fs::perms::none;  // of the folder chosen last

 private:
  static constexpr std::array<const char*, 5> kVariables = {"CACHE_DIRECTORY", "XDG_CACHE_HOME",
                                                            "HOME", "XDG_RUNTIME_DIR", "TMPDIR"};
  std::map<std::string, std::string> before_;
};

TEST_F(FolderOfUser, IsThatOfTheServiceThenOfTheCachesThenOfTheHome) {
  setenv("HOME", Made("home").c_str(), 1);
  EXPECT_EQ(Chosen(), "home/.cache/kinescope");
  EXPECT_EQ(permissions_, fs::perms::owner_all);
  setenv("XDG_CACHE_HOME", Made("xdg").c_str(), 1);
  EXPECT_EQ(Chosen(), "xdg/kinescope");
  setenv("CACHE_DIRECTORY", (Made("service") + ":/elsewhere").c_str(), 1);
  EXPECT_EQ(Chosen(), "service");
}

TEST_F(FolderOfUser, IsPrivateAndTemporaryWithoutAHome) {
  const std::string temporary = Chosen();
  EXPECT_THAT(temporary, ::testing::StartsWith("tmp/kinescope-"));
  EXPECT_EQ(permissions_, fs::perms::owner_all);
  EXPECT_NE(Chosen(), temporary) << "nobody can guess it";
  EXPECT_FALSE(fs::exists(folder_ / temporary)) << "removed with the cache";
  EXPECT_EQ(Chosen(MeshCache::Lifetime::kUser), "") << "files that stay need a folder that stays";
}

TEST_F(FolderOfUser, IsTheOneOfTheLoginIfThatIsPrivate) {
  setenv("XDG_RUNTIME_DIR", Made("run").c_str(), 1);
  fs::permissions(folder_ / "run", fs::perms::owner_all);
  EXPECT_EQ(Chosen(), "run/kinescope");
  fs::permissions(folder_ / "run", fs::perms::owner_all | fs::perms::group_exec);
  EXPECT_THAT(Chosen(), ::testing::StartsWith("tmp/"));
}

TEST_F(FolderOfUser, IsNeverOneThatOthersMayHaveFilled) {
  setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
  fs::create_directory_symlink(Made("elsewhere"), folder_ / "kinescope");
  EXPECT_THAT(Chosen(), ::testing::StartsWith("tmp/")) << "a link";
  fs::remove(folder_ / "kinescope");
  fs::create_directory(folder_ / "kinescope");
  fs::permissions(folder_ / "kinescope", fs::perms::all);
  EXPECT_THAT(Chosen(), ::testing::StartsWith("tmp/")) << "writable by everybody";
  fs::remove(folder_ / "kinescope");
  std::ofstream(folder_ / "kinescope") << "a file where the folder has to be";
  EXPECT_THAT(Chosen(), ::testing::StartsWith("tmp/"));
  fs::remove(folder_ / "kinescope");
  fs::create_directory(folder_ / "kinescope");
  if (getuid() == 0 && chown((folder_ / "kinescope").c_str(), 1, 1) == 0) {
    EXPECT_THAT(Chosen(), ::testing::StartsWith("tmp/")) << "of another user";
  }
}

TEST_F(FolderOfUser, IsMissingWhereNothingCanBeWritten) {
  setenv("HOME", "/proc/nothere", 1);
  setenv("TMPDIR", "/proc/nothere", 1);
  EXPECT_EQ(Chosen(), "");
}

}  // namespace
}  // namespace kinescope::app
