// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "host_tools/tactus/programs.hpp"
#include "platform/program/run_program.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/program_log.hpp"
#include "transport/base/read_file.hpp"
#include "transport/content_hash.hpp"
#include "transport/store/model_store.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace tactus::tactus_program
{

namespace
{

namespace fs = std::filesystem;

/// Fault of a model's file, every byte of which is checked; empty if there is none.
std::optional<Refusal> fault_of_model(const fs::path& path)
{
    const auto store = ModelStore::open(path); // It checks all but the chunks.
    if (!store)
    {
        return store.error();
    }
    std::vector<std::byte> chunk;
    for (std::uint32_t i = 0; i < store.value().header().counts().chunks(); ++i)
    {
        if (const auto read = store.value().read({ContentKind::chunk, i}, chunk); !read)
        {
            return read.error();
        }
    }
    return std::nullopt;
}

/// Folders for models, the preferred one first.
std::vector<fs::path> cache_folders(const fs::path& mesh)
{
    std::vector<fs::path> folders{mesh.parent_path() / ".tactus"};
    const char* const cache = std::getenv("XDG_CACHE_HOME");
    const char* const home = std::getenv("HOME");
    if (cache != nullptr && fs::path(cache).is_absolute())
    {
        folders.push_back(fs::path(cache) / "tactus");
    }
    else if (home != nullptr && fs::path(home).is_absolute())
    {
        folders.push_back(fs::path(home) / ".cache/tactus");
    }
    return folders;
}

std::string key_of(const std::string& content, const std::vector<std::string>& options)
{
    std::string all = fmt::format("{} {} {}", TACTUS_VERSION, kFormatVersion, kCoderVersion);
    for (const std::string& option : options)
    {
        all += '\0' + option;
    }
    all += '\0' + hash_text(content_hash(std::as_bytes(std::span(content))));
    return hash_text(content_hash(std::as_bytes(std::span(all))));
}

} // namespace

std::variant<std::string, int> cached_model(const CommandLine& line, const std::string& mesh,
                                            const std::vector<std::string>& options)
{
    std::string key;
    {
        const auto content = read_file(mesh);
        if (!content)
        {
            return line.fail(fmt::format("{}: {}", mesh, content.error().text));
        }
        key = key_of(content.value(), options);
    } // spm_build needs the memory.
    const fs::path name = fs::path(mesh).stem() += ".spm";
    const std::vector<fs::path> folders = cache_folders(mesh);
    for (const fs::path& folder : folders)
    {
        const fs::path model = folder / key / name;
        std::error_code unread;
        if (!fs::exists(model, unread))
        {
            continue;
        }
        const auto fault = fault_of_model(model);
        if (!fault)
        {
            print_out(printable_line(fmt::format("model       {}, built before", model.string())) +
                      '\n');
            return model.string();
        }
        log_message(LogLevel::warning, "tactus", fault->text + "; building the model again");
    }
    std::string reasons;
    for (const fs::path& folder : folders)
    {
        const fs::path place = folder / key;
        std::error_code error;
        fs::create_directories(place, error);
        if (!error && ::access(place.c_str(), W_OK) == 0)
        {
            std::vector<std::string> arguments = options;
            arguments.insert(arguments.end(), {"--output=" + (place / name).string(), "--", mesh});
            const int code = wait_for(start("spm_build", std::move(arguments)));
            if (code == kExitDone)
            {
                return (place / name).string();
            }
            fs::remove(place, error); // Only if they are empty.
            fs::remove(folder, error);
            return code;
        }
        reasons += fmt::format("; {}: {}", folder.string(),
                               error ? error.message() : "it can't be written");
    }
    return line.fail("no folder for the model" + reasons);
}

} // namespace tactus::tactus_program
