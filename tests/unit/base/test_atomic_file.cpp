// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/temporary_folder.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/base/suggestions.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace tactus::test
{
namespace
{

std::span<const std::byte> bytes_of(std::string_view text)
{
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string content_of(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(AtomicFile, appears_with_its_content_at_commit_and_not_before)
{
    const TemporaryFolder directory("atomic-file");
    const auto path = directory.path() / "a.bin";
    auto sut = AtomicFile::create(path);
    ASSERT_TRUE(sut) << sut.error().text;
    ASSERT_TRUE(sut.value().write(bytes_of("hello ")));
    ASSERT_TRUE(sut.value().write(bytes_of("world")));
    ASSERT_TRUE(sut.value().write_at(0, bytes_of("J")));
    ASSERT_TRUE(sut.value().write(bytes_of("!")));
    EXPECT_FALSE(std::filesystem::exists(path));
    ASSERT_TRUE(sut.value().commit());
    EXPECT_EQ(sut.value().bytes(), 12U);
    EXPECT_EQ(content_of(path), "Jello world!");
    EXPECT_EQ(directory.files(), 1U);
}

TEST(AtomicFile, leaves_nothing_behind_without_commit)
{
    const TemporaryFolder directory("atomic-file");
    {
        auto sut = AtomicFile::create(directory.path() / "a.bin");
        ASSERT_TRUE(sut);
        ASSERT_TRUE(sut.value().write(bytes_of("half")));
        EXPECT_EQ(directory.files(), 1U);
    }
    EXPECT_EQ(directory.files(), 0U);
}

TEST(AtomicFile, leaves_the_old_file_alone_until_commit_and_keeps_the_umask)
{
    const TemporaryFolder directory("atomic-file");
    const auto path = directory.write("a.bin", "old");
    {
        auto sut = AtomicFile::create(path);
        ASSERT_TRUE(sut);
        ASSERT_TRUE(sut.value().write(bytes_of("new")));
    }
    EXPECT_EQ(content_of(path), "old");
    const mode_t before = ::umask(027);
    auto sut = AtomicFile::create(path);
    ::umask(before);
    ASSERT_TRUE(sut);
    ASSERT_TRUE(sut.value().write(bytes_of("new")));
    ASSERT_TRUE(sut.value().commit());
    EXPECT_EQ(content_of(path), "new");
    struct stat status
    {
    };
    ASSERT_EQ(::stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST(AtomicFile, replaces_what_a_link_leads_to_and_leaves_the_link)
{
    const TemporaryFolder directory("atomic-file");
    std::filesystem::create_directory(directory.path() / "store");
    const auto real = directory.path() / "store" / "v1.bin";
    std::ofstream(real) << "old";
    const auto link = directory.path() / "current.bin";
    std::filesystem::create_symlink(std::filesystem::path("store") / "v1.bin", link);
    auto sut = AtomicFile::create(link);
    ASSERT_TRUE(sut) << sut.error().text;
    ASSERT_TRUE(sut.value().write(bytes_of("new")));
    EXPECT_EQ(content_of(real), "old");
    ASSERT_TRUE(sut.value().commit());
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(content_of(real), "new");
    // A dangling link is replaced by a file.
    const auto dangling = directory.path() / "dangling.bin";
    std::filesystem::create_symlink("nowhere", dangling);
    auto other = AtomicFile::create(dangling);
    ASSERT_TRUE(other) << other.error().text;
    ASSERT_TRUE(other.value().commit());
    EXPECT_FALSE(std::filesystem::is_symlink(dangling));
}

TEST(AtomicFile, does_not_follow_another_users_link_in_a_folder_where_all_may_write)
{
    if (::geteuid() != 0)
    {
        GTEST_SKIP() << "only root can give a link to another user";
    }
    constexpr uid_t kNobody = 65'534;
    const TemporaryFolder directory("atomic-file");
    const auto real = directory.path() / "real.bin";
    for (const bool is_open : {true, false})
    {
        std::ofstream(real) << "old";
        const auto folder = directory.path() / (is_open ? "open" : "closed");
        std::filesystem::create_directory(folder);
        ASSERT_EQ(::chmod(folder.c_str(), is_open ? 01777 : 0755), 0);
        const auto link = folder / "link.bin";
        std::filesystem::create_symlink(real, link);
        ASSERT_EQ(::lchown(link.c_str(), kNobody, kNobody), 0);
        auto sut = AtomicFile::create(link);
        ASSERT_TRUE(sut) << sut.error().text;
        ASSERT_TRUE(sut.value().write(bytes_of("new")));
        ASSERT_TRUE(sut.value().commit());
        EXPECT_EQ(content_of(real), is_open ? "old" : "new");
        EXPECT_EQ(content_of(link), "new");
        EXPECT_EQ(std::filesystem::is_symlink(link), !is_open);
    }
}

TEST(AtomicFile, moves_its_partial_file_along)
{
    const TemporaryFolder directory("atomic-file");
    auto first = AtomicFile::create(directory.path() / "a.bin");
    auto second = AtomicFile::create(directory.path() / "b.bin");
    ASSERT_TRUE(first && second);
    EXPECT_EQ(directory.files(), 2U);
    first.value() = std::move(second.value());
    EXPECT_EQ(directory.files(), 1U);
    ASSERT_TRUE(first.value().commit());
    EXPECT_TRUE(std::filesystem::exists(directory.path() / "b.bin"));
}

TEST(AtomicFile, refuses_places_where_no_file_can_be_made)
{
    const TemporaryFolder directory("atomic-file");
    const std::vector<std::filesystem::path> places{directory.path(),
                                                    directory.path() / "no" / "a.bin",
                                                    "/dev/null",
                                                    "",
                                                    directory.path() / "",
                                                    directory.path() / std::string(300, 'x'),
                                                    directory.write("file", "x") / "a.bin"};
    for (const auto& place : places)
    {
        const auto sut = AtomicFile::create(place);
        ASSERT_FALSE(sut) << place;
        EXPECT_TRUE(sut.error().text.starts_with(place.string() + ": can't be written: "))
            << sut.error().text;
        EXPECT_EQ(sut.error().text.find('\n'), std::string::npos) << sut.error().text;
    }
    EXPECT_EQ(directory.files(), 1U);
}

TEST(AtomicFile, finds_out_before_a_run_whether_a_file_can_be_written_and_leaves_nothing_behind)
{
    const TemporaryFolder directory("atomic-file");
    EXPECT_FALSE(AtomicFile::probe(directory.path() / "a.bin"));
    EXPECT_EQ(directory.files(), 0U);
    EXPECT_FALSE(AtomicFile::probe(directory.write("old.bin", "old")));
    EXPECT_EQ(content_of(directory.path() / "old.bin"), "old");
    const auto refused = AtomicFile::probe(directory.path());
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->text, directory.path().string() +
                                 ": can't be written: the path is a directory, device or pipe");
}

TEST(AtomicFile, refuses_one_too_many_and_takes_one_more_after_a_release)
{
    const TemporaryFolder directory("atomic-file");
    std::vector<AtomicFile> open;
    for (std::size_t i = 0; i < AtomicFile::kMaxPending; ++i)
    {
        auto sut = AtomicFile::create(directory.path() / "a.bin");
        ASSERT_TRUE(sut) << sut.error().text;
        open.push_back(std::move(sut).value());
    }
    EXPECT_FALSE(AtomicFile::create(directory.path() / "a.bin"));
    open.pop_back();
    EXPECT_TRUE(AtomicFile::create(directory.path() / "a.bin"));
    open.clear();
    EXPECT_EQ(directory.files(), 0U);
}

/// Runs in a child process, so that changes of limits and signals end with it.
template <typename Body>
int status_of_child(Body body)
{
    const pid_t child = ::fork();
    if (child == 0)
    {
        ::_exit(body());
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    return status;
}

TEST(AtomicFile, tells_of_a_full_disk_by_the_name_it_was_given_and_leaves_nothing_behind)
{
    const TemporaryFolder directory("atomic-file");
    const int status = status_of_child(
        [&]
        {
            // Writing more fails with EFBIG, with the signal ignored.
            const rlimit limit{1000, 1000};
            ::setrlimit(RLIMIT_FSIZE, &limit);
            ::signal(SIGXFSZ, SIG_IGN);
            std::filesystem::current_path(directory.path());
            auto sut = AtomicFile::create("a.bin");
            const std::string much(5000, 'x');
            const auto written = sut.value().write(bytes_of(much));
            return !written && written.error().text == "a.bin: can't be written: File too large"
                       ? 0
                       : 1;
        });
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
    EXPECT_EQ(directory.files(), 0U);
}

TEST(AtomicFile, removes_its_partial_files_when_a_signal_ends_the_process)
{
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    {
        const TemporaryFolder directory("atomic-file");
        directory.write("old.bin", "old");
        const int status = status_of_child(
            [&]
            {
                ::signal(signal, SIG_DFL);
                AtomicFile::remove_pending_on_signal();
                auto first = AtomicFile::create(directory.path() / "a.bin");
                auto second = AtomicFile::create(directory.path() / "old.bin");
                auto third = AtomicFile::create(directory.path() / "kept.bin");
                if (!first || !second || !third || !third.value().commit())
                {
                    return 1;
                }
                ::raise(signal);
                return 2;
            });
        EXPECT_TRUE(WIFSIGNALED(status));
        EXPECT_EQ(WTERMSIG(status), signal);
        EXPECT_EQ(directory.files(), 2U);
        EXPECT_EQ(content_of(directory.path() / "old.bin"), "old");
    }
}

TEST(AtomicFile, leaves_an_ignored_signal_ignored)
{
    const TemporaryFolder directory("atomic-file");
    const int status = status_of_child(
        [&]
        {
            ::signal(SIGHUP, SIG_IGN);
            AtomicFile::remove_pending_on_signal();
            ::raise(SIGHUP);
            return 7;
        });
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 7);
}

} // namespace
} // namespace tactus::test

namespace tactus
{
namespace
{

TEST(FilesNear, is_the_file_with_the_ending_that_was_left_out)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "plate.spm") << "x";
    const std::string path = (folder.path() / "plate").string();
    EXPECT_EQ(files_near(path, ".spm"), "; " + path + ".spm exists");
}

TEST(FilesNear, lists_what_else_the_folder_has)
{
    const test::TemporaryFolder folder;
    const std::string path = folder.path().string();
    EXPECT_EQ(files_near(path + "/ball.spm", ".spm"), "; " + path + " has no .spm");
    for (const char* name : {"d.spm", "a.spm", "c.spm", "b.spm", "a.obj", ".spm"})
    {
        std::ofstream(folder.path() / name) << "x";
    }
    EXPECT_EQ(files_near(path + "/ball.spm", ".spm"),
              "; " + path + " has a.spm, b.spm, c.spm, d.spm");
    for (const char* name : {"e.spm", "f.spm", "g\n.spm"})
    {
        std::ofstream(folder.path() / name) << "x";
    }
    EXPECT_EQ(files_in(path, ".spm"), "a.spm, b.spm, c.spm, d.spm, e.spm and 2 more");
    EXPECT_EQ(files_near(path + "/nowhere/ball.spm", ".spm"),
              "; no such folder: " + path + "/nowhere");
}

} // namespace
} // namespace tactus
