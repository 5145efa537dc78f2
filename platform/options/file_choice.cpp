// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/option_table.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/read_file.hpp"
#include "transport/base/suggestions.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

namespace
{

/// Name of a model or scene, and the option that gives it.
struct Named
{
    std::string option;
    std::string name;
};

std::vector<Named> names_of(const Options& options, const RawOptions& raw)
{
    std::vector<Named> all;
    for (const std::string& model : raw.models)
    {
        all.push_back({"--model", model});
    }
    if (!options.scene.empty())
    {
        all.push_back({"--scene", options.scene});
    }
    for (std::size_t i = 0; i < options.tools.size(); ++i)
    {
        if (std::string model = options.tools[i].mesh_model(); !model.empty())
        {
            all.push_back({options.of_tool("--tool", i), std::move(model)});
        }
    }
    return all;
}

std::string place_file(const std::string& file, Options& options, RawOptions& raw,
                       const std::string& commands)
{
    if (!is_file_name(file, options.readers))
    {
        const std::string shown = printable(file);
        if (std::error_code code; std::filesystem::is_directory(file, code))
        {
            return fmt::format("'{}' is a folder; it has {}", shown, files_in(file, ".spm"));
        }
        if (file.ends_with(".rec"))
        {
            return fmt::format("'{}' is a recording; replay it with --replay {}", shown, shown);
        }
        return std::filesystem::exists(file + ".spm")
                   ? fmt::format("'{}': the file is '{}.spm'", shown, shown)
                   : fmt::format("'{}' is neither a command ({}) nor a file of a model or scene "
                                 "(.spm, .gltf, .glb); use --model NAME for a published model",
                                 shown, commands);
    }
    if (!options.readers.is_scene_name(file))
    {
        raw.models.push_back(file);
        return {};
    }
    if (!options.scene.empty())
    {
        return fmt::format("'{}' is a second scene; only one scene is possible", printable(file));
    }
    options.scene = file;
    return {};
}

} // namespace

bool is_file_name(const std::string& text, const FileReaders& readers)
{
    return text.find('/') != std::string::npos || text.ends_with(".spm") ||
           readers.is_mesh_name(text) || readers.is_scene_name(text);
}

std::string assign_files(Options& options, RawOptions& raw, const std::string& commands)
{
    for (const std::string& file : raw.files)
    {
        if (std::string fault = place_file(file, options, raw, commands); !fault.empty())
        {
            return fault;
        }
    }
    const std::vector<Named> all = names_of(options, raw);
    for (const Named& named : all)
    {
        if (options.readers.is_mesh_name(named.name))
        {
            return fmt::format("{}: {}", named.option,
                               options.readers.mesh_is_no_model(named.name));
        }
    }
    const bool are_files = raw.transport == "file";
    const auto pinned = std::ranges::find_if(
        all, [](const Named& named) { return named.name.find(".spm@") != std::string::npos; });
    if (are_files && pinned != all.end())
    {
        return fmt::format(
            "{}: '{}': only published models take a hash; give a file without a hash",
            pinned->option, printable(pinned->name));
    }
    if (raw.transport)
    {
        return {};
    }
    const auto is_file = [&options](const Named& named)
    { return is_file_name(named.name, options.readers); };
    const auto file = std::ranges::find_if(all, is_file);
    const auto published = std::ranges::find_if_not(all, is_file);
    if (file != all.end() && published != all.end())
    {
        return fmt::format("{}: '{}' is a file and '{}' a published name; give all as files ('{}' "
                           "as '{}.spm') or all as names",
                           file->option, printable(file->name), printable(published->name),
                           printable(published->name), printable(published->name));
    }
    raw.transport = file != all.end() ? "file" : "dds";
    return {};
}

namespace
{

using Key = std::array<unsigned char, 32>;
static_assert(std::tuple_size_v<Key> >= crypto_generichash_blake2b_KEYBYTES_MIN);
static_assert(std::tuple_size_v<Key> <= crypto_generichash_blake2b_KEYBYTES_MAX);

class KeyedHash final : public udp::Authenticator
{
public:
    explicit KeyedHash(const Key& key) noexcept : key_(key) {}

    [[nodiscard]] udp::Tag tag_of(std::span<const std::byte> bytes) const noexcept override
    {
        std::array<unsigned char, std::tuple_size_v<udp::Tag>> tag{};
        crypto_generichash_blake2b(tag.data(), tag.size(),
                                   reinterpret_cast<const unsigned char*>(bytes.data()),
                                   bytes.size(), key_.data(), key_.size());
        return std::bit_cast<udp::Tag>(tag);
    }

private:
    Key key_;
};

constexpr std::string_view kSpace = " \t\r\n";

std::string_view trimmed(std::string_view text)
{
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    return text.substr(0, text.find_last_not_of(kSpace) + 1);
}

/// True if others than owner and group may read the file.
bool is_open_to_all(const std::string& path)
{
    std::error_code error;
    const auto rights = std::filesystem::status(path, error).permissions();
    return !error && (rights & std::filesystem::perms::others_read) != std::filesystem::perms::none;
}

} // namespace

Result<std::shared_ptr<const udp::Authenticator>, Refusal> read_device_key(const std::string& path)
{
    const auto refused = [&path](std::string_view why)
    { return Refusal{fmt::format("--device-key: {}: {}", printable(path), why)}; };
    if (is_open_to_all(path))
    {
        return refused("all users may read the file; protect it with chmod 600");
    }
    const auto bytes = read_file(path);
    if (!bytes)
    {
        return refused(bytes.error().text);
    }
    const std::string_view digits = trimmed(bytes.value());
    Key key{};
    std::size_t made = 0;
    const bool is_hex = sodium_hex2bin(key.data(), key.size(), digits.data(), digits.size(),
                                       nullptr, &made, nullptr) == 0;
    if (!is_hex || digits.size() != 2 * key.size() || made != key.size())
    {
        return refused("must hold 64 hexadecimal digits and nothing else");
    }
    return std::shared_ptr<const udp::Authenticator>(std::make_shared<KeyedHash>(key));
}

} // namespace tactus::hrtc
