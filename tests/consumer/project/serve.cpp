// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// serve FILE [DOMAIN]: encodes a mesh of its own as FILE; with a DOMAIN it then publishes the model
// `ring` there until it is ended.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <tactus/host_tools/encode/write_spm.hpp>
#include <tactus/host_tools/mesh/prepare.hpp>
#include <tactus/host_tools/simplify/simplify.hpp>
#include <tactus/transport/dds/dds_host.hpp>
#include <tactus/version.hpp>
#include <utility>
#include <vector>

namespace
{

constexpr std::uint32_t kAround = 64;
constexpr std::uint32_t kAcross = 32;

/// A ring of 8 cm with a wave on it, metres, faces counter-clockwise seen from outside.
tactus::TriangleMesh make_ring()
{
    tactus::TriangleMesh mesh;
    for (std::uint32_t i = 0; i < kAround; ++i)
    {
        const double along = 2.0 * std::numbers::pi * i / kAround;
        for (std::uint32_t k = 0; k < kAcross; ++k)
        {
            const double across = 2.0 * std::numbers::pi * k / kAcross;
            const double thick_m = 0.012 + 0.001 * std::sin(5.0 * along + across);
            const double out_m = 0.028 + thick_m * std::cos(across);
            mesh.positions.push_back(
                {out_m * std::cos(along), out_m * std::sin(along), thick_m * std::sin(across)});
        }
    }
    const auto at = [](std::uint32_t i, std::uint32_t k)
    { return (i % kAround) * kAcross + k % kAcross; };
    for (std::uint32_t i = 0; i < kAround; ++i)
    {
        for (std::uint32_t k = 0; k < kAcross; ++k)
        {
            mesh.faces.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.faces.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    }
    return mesh;
}

int fail(const tactus::Refusal& refusal)
{
    std::fprintf(stderr, "serve: %s\n", refusal.text.c_str());
    return 2;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 2)
    {
        std::fprintf(stderr, "usage: serve FILE [DOMAIN]\n");
        return 3;
    }
    const auto prepared = tactus::prepare_mesh(make_ring(), {});
    if (!prepared)
    {
        return fail(prepared.error());
    }
    const auto simplified = tactus::simplify(prepared.value().mesh, {});
    if (!simplified)
    {
        return fail(simplified.error());
    }
    const auto written = tactus::write_spm(argv[1], prepared.value(), simplified.value(), {});
    if (!written)
    {
        return fail(written.error());
    }
    std::printf("%s: %u faces, with Tactus %s\n", argv[1], written.value().source_faces,
                TACTUS_VERSION_STRING);
    if (argc < 3)
    {
        return 0;
    }
    auto store = tactus::ModelStore::open(argv[1]);
    if (!store)
    {
        return fail(store.error());
    }
    std::vector<tactus::dds::PublishedModel> models;
    models.push_back({"ring", std::move(store).value()});
    const auto domain = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
    const auto host = tactus::dds::DdsHost::create(domain, std::move(models), {});
    if (!host)
    {
        return fail(host.error());
    }
    for (;;)
    {
        host.value()->wait(std::chrono::milliseconds(100));
        host.value()->step();
    }
}
