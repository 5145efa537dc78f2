// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace tactus
{

/// Why a file could not be written: one line with the file's name.
struct FileError
{
    std::string text;
};

/// A file that appears whole or not at all. Bytes go to a temporary in the same directory; commit()
/// makes them durable and gives them the name; until then the destructor removes them.
/// For one thread; different files may be written from different threads.
class AtomicFile
{
public:
    /// At most this many files may be open for writing in one process: the signal handler finds
    /// them in memory of fixed size.
    static constexpr std::size_t kMaxPending = 16;

    /// Makes the temporary beside `path`. Refused when `path` is something else than a regular
    /// file, or when its directory is missing or can't be written.
    [[nodiscard]] static Result<AtomicFile, FileError> create(const std::filesystem::path& path);

    /// From now on SIGINT, SIGTERM and SIGHUP remove every temporary before they end the process as
    /// usual; a signal that is ignored stays ignored. Replaces the program's own handlers.
    static void remove_pending_on_signal();

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    /// Appends; write_at() does not move the end of what write() appends to.
    [[nodiscard]] Result<Done, FileError> write(std::span<const std::byte> bytes);
    /// Overwrites, or extends, at a byte offset from the start.
    [[nodiscard]] Result<Done, FileError> write_at(std::uint64_t offset,
                                                   std::span<const std::byte> bytes);
    /// Flushes to the disk and renames. After a refusal the old file is untouched and the temporary
    /// is gone; after either nothing more may be written.
    [[nodiscard]] Result<Done, FileError> commit();

private:
    AtomicFile(std::filesystem::path path, std::filesystem::path temporary, int descriptor,
               std::size_t slot);

    void discard() noexcept;
    [[nodiscard]] FileError error(const char* what) const;

    std::filesystem::path path_;
    std::filesystem::path temporary_;
    int descriptor_{-1}; ///< -1 once committed, discarded or moved from.
    std::size_t slot_{0};
    std::uint64_t end_{0};
};

} // namespace tactus
