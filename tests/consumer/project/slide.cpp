// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// slide FILE DOMAIN: publishes a model and shows a cup of it, which slides where the tools of all
// controllers push it, on a spring, until it is ended. Says each second where the cup is and who
// pushes it.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <tactus/rt_core/math/vec3.hpp>
#include <tactus/transport/dds/dds_host.hpp>
#include <tactus/transport/dds/telemetry.hpp>
#include <utility>
#include <vector>

namespace
{

constexpr double kMass_kg = 1.0;
constexpr double kSpring_n_per_m = 50.0; ///< It pulls the cup back to where it was.
constexpr double kStep_s = 0.01;

int fail(const tactus::Refusal& refusal)
{
    std::fprintf(stderr, "slide: %s\n", refusal.text.c_str());
    return 2;
}

/// What the tools of all controllers push an object with, in newtons; `pushing` is how many do.
tactus::Vec3 push_on(std::uint32_t object, const tactus::dds::DdsHost& host,
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
            if (pair.host_epoch == host.epoch() && pair.object == object)
            {
                push_n += tactus::Vec3(pair.force_n[0], pair.force_n[1], pair.force_n[2]);
            }
        }
        pushing += push_n != before_n ? 1 : 0;
    }
    return push_n;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 3)
    {
        std::fprintf(stderr, "usage: slide FILE DOMAIN\n");
        return 3;
    }
    auto store = tactus::ModelStore::open(argv[1]);
    if (!store)
    {
        return fail(store.error());
    }
    const tactus::ContentHash model = store.value().hash();
    std::vector<tactus::dds::PublishedModel> models;
    models.push_back({"cup", std::move(store).value()});
    const auto domain = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
    const auto made = tactus::dds::DdsHost::create(domain, std::move(models), {});
    if (!made)
    {
        return fail(made.error());
    }
    tactus::dds::DdsHost& host = *made.value();
    const auto watch = tactus::dds::TelemetryReader::create(host.domain());
    if (!watch)
    {
        return fail(watch.error());
    }
    tactus::Pose pose;
    const auto cup = host.objects().show({"cup", model, {}, pose});
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
            host.wait(std::chrono::milliseconds(1));
            host.step();
        }
        watch.value()->poll();
        const tactus::Vec3 push_n = push_on(cup.value(), host, *watch.value(), pushing);
        const auto& [x_m, y_m, z_m] = pose.translation_m;
        const tactus::Vec3 pull_n = -kSpring_n_per_m * tactus::Vec3(x_m, y_m, z_m);
        velocity_m_per_s += kStep_s / kMass_kg * (push_n + pull_n);
        velocity_m_per_s *= 0.8; // It is slowed down.
        pose.translation_m[0] += kStep_s * velocity_m_per_s.x();
        pose.translation_m[1] += kStep_s * velocity_m_per_s.y();
        pose.translation_m[2] += kStep_s * velocity_m_per_s.z();
        if (!host.objects().move(cup.value(), pose))
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
