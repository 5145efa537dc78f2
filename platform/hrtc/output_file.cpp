// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace tactus::hrtc
{

namespace
{

std::string partial_of(const std::string& path)
{
    return path + ".partial";
}

OutputFileError refusal(const std::string& path, const std::string& reason)
{
    return {path + ": can't be written: " + reason};
}

} // namespace

Result<OutputFile, OutputFileError> OutputFile::create(const std::string& path)
{
    std::error_code ignored;
    // Taking the place of a device or pipe would be no service to anybody.
    if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    {
        return refusal(path, "it is a directory, device or pipe");
    }
    std::FILE* file = std::fopen(partial_of(path).c_str(), "wb");
    if (file == nullptr)
    {
        return refusal(path, std::strerror(errno));
    }
    return OutputFile(path, file);
}

OutputFile::~OutputFile()
{
    if (file_ != nullptr)
    {
        std::error_code ignored;
        std::filesystem::remove(partial_of(path_), ignored);
    }
}

std::optional<OutputFileError> OutputFile::write(std::span<const std::byte> bytes)
{
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    {
        return refusal(path_, std::strerror(errno));
    }
    bytes_ += bytes.size();
    return std::nullopt;
}

std::optional<OutputFileError> OutputFile::commit()
{
    if (std::fflush(file_.get()) != 0)
    {
        return refusal(path_, std::strerror(errno));
    }
    std::error_code error;
    std::filesystem::rename(partial_of(path_), path_, error);
    if (error)
    {
        return refusal(path_, error.message());
    }
    file_.reset();
    return std::nullopt;
}

std::optional<OutputFileError> probe_output(const std::string& path)
{
    if (path.empty())
    {
        return std::nullopt;
    }
    const auto file = OutputFile::create(path);
    return file ? std::nullopt : std::optional(file.error());
}

} // namespace tactus::hrtc
