// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// serve FILE [DOMAIN]: encodes a mesh of its own as FILE. With a DOMAIN it then publishes the model
// under the file's name and shows a cup of it until it is ended. The cup is on a spring and slides
// when the controllers' tools push it. Prints each second the cup's position and the pushing tools.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <tactus/host_tools/encode/write_spm.hpp>
#include <tactus/host_tools/mesh/prepare.hpp>
#include <tactus/host_tools/simplify/simplify.hpp>
#include <tactus/rt_core/math/vec3.hpp>
#include <tactus/transport/dds/dds_server.hpp>
#include <tactus/transport/dds/telemetry.hpp>
#include <tactus/version.hpp>
#include <utility>
#include <vector>

namespace
{

constexpr std::uint32_t kAround = 64;
constexpr std::uint32_t kAcross = 32;

/// Ring of 8 cm with a wave on it, in metres, faces counter-clockwise seen from outside.
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

constexpr double kMass_kg = 1.0;
constexpr double kSpring_n_per_m = 50.0; ///< Stiffness of the spring that pulls the cup back.
constexpr double kStep_s = 0.01;

int fail(const tactus::Refusal& refusal)
{
    std::fprintf(stderr, "serve: %s\n", refusal.text.c_str());
    return 2;
}

/// Sum of the controllers' forces on an object, in newtons; `pushing` is the number of controllers.
tactus::Vec3 push_on(std::uint32_t object, const tactus::dds::DdsServer& server,
                     const tactus::dds::TelemetryReader& watch, int& pushing)
{
    tactus::Vec3 push_n(0.0, 0.0, 0.0);
    pushing = 0;
    for (const auto& controller : watch.controllers())
    {
        const tactus::Vec3 before_n = push_n;
        for (std::uint32_t i = 0; i < controller.telemetry.pair_count; ++i)
        {
            const tactus::PairTelemetry& pair = controller.telemetry.pairs[i];
            if (pair.server_epoch == server.epoch() && pair.object == object)
            {
                push_n += tactus::Vec3(pair.force_n[0], pair.force_n[1], pair.force_n[2]);
            }
        }
        pushing += push_n != before_n ? 1 : 0;
    }
    return push_n;
}

int publish(const std::filesystem::path& file, std::uint32_t domain)
{
    auto store = tactus::ModelStore::open(file);
    if (!store)
    {
        return fail(store.error());
    }
    const tactus::ContentHash model = store.value().hash();
    std::vector<tactus::dds::PublishedModel> models;
    models.push_back({file.stem().string(), std::move(store).value()});
    const auto made = tactus::dds::DdsServer::create(domain, std::move(models), {});
    if (!made)
    {
        return fail(made.error());
    }
    tactus::dds::DdsServer& server = *made.value();
    const auto watch = tactus::dds::TelemetryReader::create(server.domain());
    if (!watch)
    {
        return fail(watch.error());
    }
    tactus::Pose pose;
    const auto cup = server.objects().show({"cup", model, {}, pose});
    if (!cup)
    {
        return fail(cup.error());
    }
    tactus::Vec3 velocity_m_per_s(0.0, 0.0, 0.0);
    int pushing = 0;
    int steps = 0;
    for (auto next = std::chrono::steady_clock::now();;)
    {
        next += std::chrono::milliseconds(10);
        while (std::chrono::steady_clock::now() < next)
        {
            server.wait(std::chrono::milliseconds(1));
            server.step();
        }
        watch.value()->poll();
        const tactus::Vec3 push_n = push_on(cup.value(), server, *watch.value(), pushing);
        const auto& [x_m, y_m, z_m] = pose.translation_m;
        const tactus::Vec3 pull_n = -kSpring_n_per_m * tactus::Vec3(x_m, y_m, z_m);
        velocity_m_per_s += kStep_s / kMass_kg * (push_n + pull_n);
        velocity_m_per_s *= 0.8; // Damping.
        pose.translation_m[0] += kStep_s * velocity_m_per_s.x();
        pose.translation_m[1] += kStep_s * velocity_m_per_s.y();
        pose.translation_m[2] += kStep_s * velocity_m_per_s.z();
        if (!server.objects().move(cup.value(), pose))
        {
            return fail({"the cup is beyond the world"});
        }
        if (++steps % 100 == 0)
        {
            std::printf("cup at %.1f %.1f %.1f mm, pushed by %d of %zu controllers\n",
                        1e3 * pose.translation_m[0], 1e3 * pose.translation_m[1],
                        1e3 * pose.translation_m[2], pushing, watch.value()->controllers().size());
            std::fflush(stdout);
        }
    }
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
    return argc < 3
               ? 0
               : publish(argv[1], static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10)));
}
