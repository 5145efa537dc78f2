// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/fuzz/scratch_file.hpp"

#include "tests/fuzz/law.hpp"

#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <system_error>
#include <unistd.h>

namespace tactus::fuzz
{

ScratchFile::ScratchFile(const char* name)
{
    std::string folder = (std::filesystem::temp_directory_path() / "tactus_fuzz_XXXXXX").string();
    require(::mkdtemp(folder.data()) != nullptr, "the temporary folder can be written");
    path_ = std::filesystem::path(folder) / name;
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    require(file_ >= 0, "a temporary file can be made");
}

ScratchFile::~ScratchFile()
{
    ::close(file_);
    std::error_code ignored;
    std::filesystem::remove_all(path_.parent_path(), ignored);
}

void ScratchFile::replace(std::span<const std::byte> content)
{
    const auto bytes = static_cast<ssize_t>(content.size());
    require(::pwrite(file_, content.data(), content.size(), 0) == bytes &&
                ::ftruncate(file_, static_cast<off_t>(bytes)) == 0,
            "a temporary file can be written");
}

} // namespace tactus::fuzz
