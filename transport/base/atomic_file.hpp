// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace tactus
{

/// A file that appears whole or not at all. Bytes go to a file of its own beside it,
/// PATH.PID-N.partial; commit() makes them durable and gives them the name; until then the
/// destructor removes them. For one thread at a time; different files may be written from different
/// threads. Every refusal names the path and says that it can't be written, and why.
class AtomicFile
{
public:
    /// At most this many files may be open for writing in one process: the signal handler finds
    /// them in memory of fixed size.
    static constexpr std::size_t kMaxPending = 16;

    /// Makes the partial file beside `path`, or beside what that leads to where it is a link, which
    /// stays one; not so a link of another user in a folder where all may write, which is replaced.
    /// Refused when `path` is something else than a regular file, or when its directory is missing
    /// or can't be written.
    [[nodiscard]] static Result<AtomicFile, Refusal> create(const std::filesystem::path& path);

    /// Finds out before a long run whether a file can be written, and leaves nothing behind;
    /// returns why not.
    [[nodiscard]] static std::optional<Refusal> probe(const std::filesystem::path& path);

    /// From now on SIGINT, SIGTERM and SIGHUP remove every partial file before they end the process
    /// as usual; a signal that is ignored stays ignored. Replaces the program's own handlers.
    static void remove_pending_on_signal();

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    /// Appends; write_at() does not move the end of what write() appends to.
    [[nodiscard]] Result<Done, Refusal> write(std::span<const std::byte> bytes);
    /// Overwrites, or extends, at a byte offset from the start.
    [[nodiscard]] Result<Done, Refusal> write_at(std::uint64_t offset,
                                                 std::span<const std::byte> bytes);
    /// Flushes to the disk and renames. After a refusal the old file is untouched and the partial
    /// one is gone; after either nothing more may be written.
    [[nodiscard]] Result<Done, Refusal> commit();

    /// Where the next write() appends.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return end_; }

private:
    AtomicFile(std::string name, std::filesystem::path path, std::filesystem::path partial,
               int descriptor, std::size_t slot);

    void discard() noexcept;
    [[nodiscard]] Refusal error() const;

    std::string name_; ///< As it was given; for messages.
    std::filesystem::path path_;
    std::filesystem::path partial_;
    int descriptor_{-1}; ///< -1 once committed, discarded or moved from.
    std::size_t slot_{0};
    std::uint64_t end_{0};
};

} // namespace tactus
