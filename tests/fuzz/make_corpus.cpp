// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// make_corpus FOLDER: rewrites the seeds that contain this build's formats: models of one chunk,
/// of two with a border, and without records; recordings, a whole one and one with lost frames; and
/// conversations with a udp device. The same build writes the same bytes.

#include "host_tools/shapes/shapes.hpp"
#include "platform/devices/udp/datagram.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/platform/example_datagrams.hpp"
#include "tests/unit/recording/recorded_example.hpp"
#include "tests/unit/transport/tiny_model.hpp"

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

namespace
{

using namespace tactus;
using Bytes = std::vector<std::byte>;
namespace fs = std::filesystem;

void put_seed(const fs::path& path, std::span<const std::byte> bytes)
{
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

void make_models(const fs::path& folder)
{
    fs::create_directories(folder);
    // There is no extension: files that end in .spm are products and not kept.
    const auto add = [&](const char* name, const TriangleMesh& mesh, std::uint32_t base_faces)
    {
        fs::copy_file(test::test_model(name, mesh, base_faces).path, folder / name,
                      fs::copy_options::overwrite_existing);
    };
    add("one_chunk", make_shape(Shape::sphere, 100).value(), 16);
    add("two_chunks", make_shape(Shape::terrain, 200).value(), 24);
    add("no_records", make_thin_plate(2, 0.01).value(), 500);
}

void make_recordings(const fs::path& folder)
{
    const test::TinyModel model = test::make_tiny_model({.records = 70});
    put_seed(folder / "whole", test::example_recording(model));
    put_seed(folder / "lost_frames", test::example_recording(model, 3));
}

/// Adds a datagram as fuzz_udp_session.cpp reads it.
void add_datagram(Bytes& script, unsigned control, const udp::Datagram& datagram)
{
    for (const std::size_t byte :
         {std::size_t{control}, datagram.size() % 256, datagram.size() / 256})
    {
        script.push_back(static_cast<std::byte>(byte));
    }
    script.insert(script.end(), datagram.begin(), datagram.end());
}

/// A description, three samples and a force, in one version.
Bytes conversation(std::uint16_t version)
{
    constexpr unsigned kAfterMillisecond = 1;
    constexpr unsigned kOfSession = 8;
    auto description = test::example_description();
    auto sample = test::example_sample();
    auto force = test::example_force();
    description.version = version;
    sample.version = version;
    force.version = version;
    Bytes script;
    add_datagram(script, 0, udp::encode(description));
    for (int i = 0; i < 3; ++i)
    {
        add_datagram(script, kAfterMillisecond | kOfSession, udp::encode(sample));
        ++sample.address.sequence;
        sample.time_ns += 1'000'000;
    }
    add_datagram(script, kAfterMillisecond, udp::encode(force));
    return script;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::fputs("usage: make_corpus FOLDER\n", stderr);
        return 3;
    }
    const fs::path folder = argv[1];
    make_models(folder / "spm_reader");
    make_recordings(folder / "recording");
    put_seed(folder / "udp_session" / "version_2", conversation(udp::kVersion));
    put_seed(folder / "udp_session" / "version_1", conversation(udp::kVersionOfPoints));
    return 0;
}
