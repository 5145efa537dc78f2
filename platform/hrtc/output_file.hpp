// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace tactus::hrtc
{

/// Why a file can't be written: one line with its name.
struct OutputFileError
{
    std::string text;
};

/// A file that appears whole or not at all: it is written as PATH.partial, and commit() gives it
/// its name. What was not committed is removed by the destructor. For one thread at a time.
class OutputFile
{
public:
    /// Refused when `path` is something else than a regular file, or can't be written.
    [[nodiscard]] static Result<OutputFile, OutputFileError> create(const std::string& path);

    OutputFile(OutputFile&& other) noexcept = default;
    OutputFile& operator=(OutputFile&& other) = delete;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    /// Both return why not; nothing more may be written after that.
    [[nodiscard]] std::optional<OutputFileError> write(std::span<const std::byte> bytes);
    [[nodiscard]] std::optional<OutputFileError> commit();

    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }

private:
    struct Close
    {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };

    OutputFile(std::string path, std::FILE* file) : path_(std::move(path)), file_(file) {}

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_; ///< Null once committed, refused or moved from.
    std::uint64_t bytes_{0};
};

/// Finds out before a run whether a file can be written, and leaves nothing behind; returns why
/// not. An empty path is no file.
[[nodiscard]] std::optional<OutputFileError> probe_output(const std::string& path);

} // namespace tactus::hrtc
