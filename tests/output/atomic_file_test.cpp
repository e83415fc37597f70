#include <gtest/gtest.h>

#include "output/atomic_file.hpp"
#include "output/output_stream.hpp"
#include "support/temporary_file.hpp"

namespace krepl::test {
namespace {

namespace fs = std::filesystem;
using output::AtomicFile;
using output::OutputStream;

std::size_t entries(const TemporaryDirectory& directory) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory.path()), {}));
}

void put(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

TEST(AtomicFile, NothingShowsBeforeCommit) {
  TemporaryDirectory directory;
  directory.write("out.txt", "old");
  {
    Result<AtomicFile> file = AtomicFile::create(directory / "out.txt");
    ASSERT_TRUE(file.ok()) << file.error().text();
    EXPECT_EQ(fs::path(file->temporary_path()).filename(), "out.txt");
    put(file->temporary_path(), "new");
    EXPECT_EQ(read_text(directory / "out.txt"), "old");
    ASSERT_TRUE(file->commit().ok());
    EXPECT_EQ(read_text(directory / "out.txt"), "new");
  }
  EXPECT_EQ(entries(directory), 1u);
}

TEST(AtomicFile, WithoutCommitNothingIsLeft) {
  TemporaryDirectory directory;
  {
    Result<AtomicFile> file = AtomicFile::create(directory / "out.txt");
    ASSERT_TRUE(file.ok());
    put(file->temporary_path(), "half");
    put(file->temporary_path() + "-journal", "more");
  }
  EXPECT_EQ(entries(directory), 0u);
}

TEST(AtomicFile, FilesBesideItMoveTogether) {
  TemporaryDirectory directory;
  Result<AtomicFile> file = AtomicFile::create(directory / "out.shp");
  ASSERT_TRUE(file.ok());
  put(file->temporary_path(), "shapes");
  put(fs::path(file->temporary_path()).replace_extension("dbf").string(), "attributes");
  ASSERT_TRUE(file->commit().ok());
  EXPECT_EQ(read_text(directory / "out.shp"), "shapes");
  EXPECT_EQ(read_text(directory / "out.dbf"), "attributes");
}

TEST(AtomicFile, CommitWithoutAFileIsAnError) {
  TemporaryDirectory directory;
  Result<AtomicFile> file = AtomicFile::create(directory / "out.txt");
  ASSERT_TRUE(file.ok());
  EXPECT_FALSE(file->commit().ok());
}

TEST(AtomicFile, TwoAtATimeDoNotMeet) {
  TemporaryDirectory directory;
  Result<AtomicFile> one = AtomicFile::create(directory / "out.txt");
  Result<AtomicFile> two = AtomicFile::create(directory / "out.txt");
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_NE(one->temporary_path(), two->temporary_path());
}

TEST(OutputStream, FailureSticks) {
  Result<OutputStream> stream = OutputStream::open("/dev/full");
  ASSERT_TRUE(stream.ok()) << stream.error().text();
  stream->write(std::string(1 << 20, 'x'));
  EXPECT_TRUE(stream->failed());
  Status finished = stream->finish();
  ASSERT_FALSE(finished.ok());
  EXPECT_EQ(finished.error().code, ErrorCode::io);
}

TEST(OutputStream, LateFailureIsNoticedToo) {
  Result<OutputStream> stream = OutputStream::open("/dev/full");
  ASSERT_TRUE(stream.ok());
  stream->write("short");  // stays in the buffer until the end
  EXPECT_FALSE(stream->failed());
  EXPECT_FALSE(stream->finish().ok());
}

}  // namespace
}  // namespace krepl::test
