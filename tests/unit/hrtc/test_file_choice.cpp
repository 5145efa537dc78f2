// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/subcommands.hpp"
#include "platform/options/option_table.hpp"
#include "platform/readers/file_readers.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::hrtc
{

namespace
{

using Names = std::vector<std::string>;

struct Given
{
    Names files{};
    Names models{};
    std::string scene{};
    Names tools{};
    std::optional<std::string> transport{};
};

struct Taken
{
    std::string fault;
    Names models;
    std::string scene;
    std::string transport;
};

Taken take(const Given& given)
{
    Options options;
    options.readers = file_readers();
    options.scene = given.scene;
    RawOptions raw;
    raw.files = given.files;
    raw.models = given.models;
    raw.of_tools[0] = given.tools;
    raw.transport = given.transport;
    EXPECT_EQ(set_tools(options, raw), "");
    const std::string fault = assign_files(options, raw, subcommand_names());
    return {fault, raw.models, options.scene, raw.transport.value_or("")};
}

TEST(FileChoice, tells_files_from_published_names)
{
    for (const char* file :
         {"cow.spm", "models/cow", "./cow", "cow.obj", "cow.STL", "a.gltf", "b.GLB"})
    {
        EXPECT_TRUE(is_file_name(file, file_readers())) << file;
    }
    for (const char* name : {"cow", "cow.v2", "cow@0123", "spm", "cow.spm@0123"})
    {
        EXPECT_FALSE(is_file_name(name, file_readers())) << name;
    }
}

TEST(FileChoice, takes_files_without_an_option_as_models_or_the_scene)
{
    const Taken models = take({.files = {"a.spm", "b/c.spm"}});
    EXPECT_EQ(models.fault, "");
    EXPECT_EQ(models.models, (Names{"a.spm", "b/c.spm"}));
    EXPECT_EQ(models.transport, "file");
    const Taken scene = take({.files = {"room.glb"}});
    EXPECT_EQ(scene.fault, "");
    EXPECT_EQ(scene.scene, "room.glb");
    EXPECT_EQ(scene.transport, "file");
    EXPECT_EQ(take({.models = {"cow"}}).transport, "dds");
    EXPECT_EQ(take({.scene = "room"}).transport, "dds");
    EXPECT_EQ(take({.models = {"a.spm"}, .tools = {"mesh:d,e.spm,0.001"}}).transport, "file");
}

TEST(FileChoice, refuses_a_mixture_unless_it_is_told_where_from)
{
    EXPECT_EQ(take({.files = {"a.spm"}, .models = {"cow"}}).fault,
              "--model: 'a.spm' is a file and 'cow' a published name; give all as files ('cow' as "
              "'cow.spm') or all as names");
    EXPECT_EQ(take({.models = {"cow"}, .tools = {"sphere:0.01", "mesh:e.spm"}}).fault,
              "--tool of tool 1: 'e.spm' is a file and 'cow' a published name; give all as files "
              "('cow' as 'cow.spm') or all as names");
    const Taken told = take({.models = {"a.spm", "cow"}, .transport = "dds"});
    EXPECT_EQ(told.fault, "");
    EXPECT_EQ(told.transport, "dds");
}

TEST(FileChoice, says_what_to_do_with_a_mesh_and_with_what_is_no_file)
{
    EXPECT_EQ(take({.files = {"cow.obj"}}).fault,
              "--model: 'cow.obj' is a mesh; build a model with: spm_build cow.obj -o MODEL.spm");
    EXPECT_EQ(take({.models = {"cow"}, .tools = {"mesh:cow.ply,0.01"}}).fault,
              "--tool: 'cow.ply' is a mesh; build a model with: spm_build cow.ply -o MODEL.spm");
    EXPECT_EQ(take({.files = {"touch"}}).fault,
              "'touch' is neither a command (doctor, deadline-test, load) nor a file of a model or "
              "scene (.spm, .gltf, .glb); use --model NAME for a published model");
    const std::string hash(32, '0');
    EXPECT_EQ(take({.models = {"cow.spm@" + hash}, .transport = "file"}).fault,
              "--model: 'cow.spm@" + hash +
                  "': only published models take a hash; give a file without a hash");
    EXPECT_EQ(take({.models = {"cow.spm@" + hash}}).transport, "dds");
    EXPECT_EQ(take({.files = {"a.glb", "b.glb"}}).fault,
              "'b.glb' is a second scene; only one scene is possible");
}

} // namespace

namespace
{

std::string hex(const udp::Tag& tag)
{
    std::string text;
    for (const std::byte byte : tag)
    {
        constexpr std::string_view kDigits = "0123456789abcdef";
        text += kDigits[std::to_integer<std::size_t>(byte >> 4)];
        text += kDigits[std::to_integer<std::size_t>(byte & std::byte{15})];
    }
    return text;
}

/// Tags by Python's hashlib.blake2b(text, digest_size=16, key=bytes(range(32))).
TEST(DeviceKey, makes_keyed_tags_as_others_do)
{
    const tactus::test::TemporaryFolder folder("device_key");
    const std::filesystem::path path = folder.path() / "key";
    std::ofstream(path) << "000102030405060708090A0b0c0d0e0f"
                           "101112131415161718191a1b1c1d1e1f\r\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_read);
    const auto sut = read_device_key(path.string());
    ASSERT_TRUE(sut) << sut.error().text;
    const std::string_view text = "TCTD and what follows";
    EXPECT_EQ(hex(sut.value()->tag_of(std::as_bytes(std::span(text)))),
              "110df4e37d314fdbf2fd07711387cd1d");
    EXPECT_EQ(hex(sut.value()->tag_of({})), "3daf97bce7888fd59773c66bf647459c");
}

} // namespace

} // namespace tactus::hrtc
