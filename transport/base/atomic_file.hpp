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

/// A file that appears as a whole or not at all. Bytes go to a file beside it, PATH.PID-N.partial;
/// commit() makes them durable and renames that file. Until then the destructor removes it. One
/// thread at a time; different files may be written from different threads. Every refusal names the
/// path and the reason why it cannot be written.
class AtomicFile
{
public:
    /// Maximum number of files open for writing in one process: the signal handler finds them in
    /// memory of fixed size.
    static constexpr std::size_t kMaxPending = 16;

    /// Creates the partial file beside `path`. If `path` is a link, the link stays and its target
    /// is replaced, unless another user owns the link in a folder where all may write; then the
    /// link is replaced. Refused if `path` is not a regular file, or if its directory is missing or
    /// cannot be written.
    [[nodiscard]] static Result<AtomicFile, Refusal> create(const std::filesystem::path& path);

    /// Tests before a long run whether a file can be written, and leaves nothing behind. Returns
    /// the reason if not.
    [[nodiscard]] static std::optional<Refusal> probe(const std::filesystem::path& path);

    /// Installs handlers by which SIGINT, SIGTERM and SIGHUP remove every partial file before they
    /// end the process as usual. A signal that is ignored stays ignored. Replaces the program's own
    /// handlers.
    static void remove_pending_on_signal();

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    /// Appends bytes. write_at() does not move the position of write().
    [[nodiscard]] Result<Done, Refusal> write(std::span<const std::byte> bytes);
    /// Overwrites, or extends, at a byte offset from the start.
    [[nodiscard]] Result<Done, Refusal> write_at(std::uint64_t offset,
                                                 std::span<const std::byte> bytes);
    /// Flushes to the disk and renames. After a refusal the old file is untouched and the partial
    /// file is gone. Nothing may be written after commit().
    [[nodiscard]] Result<Done, Refusal> commit();

    /// Position of the next write().
    [[nodiscard]] std::uint64_t bytes() const noexcept { return end_; }

private:
    AtomicFile(std::string name, std::filesystem::path path, std::filesystem::path partial,
               int descriptor, std::size_t slot);

    void discard() noexcept;
    [[nodiscard]] Refusal error() const;

    std::string name_; ///< Path as given; for messages.
    std::filesystem::path path_;
    std::filesystem::path partial_;
    int descriptor_{-1}; ///< File descriptor; -1 once committed, discarded or moved from.
    std::size_t slot_{0};
    std::uint64_t end_{0};
};

} // namespace tactus
