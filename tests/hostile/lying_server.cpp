// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// lying_server DOMAIN MODEL RADIUS_M ATTACK [NUMBER]: serves a model and shows it once, as the
/// scene "toy". It reads telemetry and behaves correctly until a tool, a sphere of that radius, is
/// at the attack's place; then it repeats the attack until told to end. Prints the number of
/// attacks. Exits 2 if it cannot serve, 3 for an unknown ATTACK.

#include "platform/program/run_program.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/telemetry.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "tactus.h"

namespace
{

using namespace tactus;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

Vec3 vec3(const std::array<double, 3>& of)
{
    return {of[0], of[1], of[2]};
}

/// A controller's first tool with its nearest point.
struct Hand
{
    bool is_there{false};
    bool touches{false};
    double gap_m{0.0};
    Vec3 away{0.0, 0.0, 1.0}; ///< Direction from the object to the tool.
};

class LyingServer
{
public:
    LyingServer(std::unique_ptr<dds::DdsServer> server,
                std::unique_ptr<dds::TelemetryReader> reader, double radius_m)
        : server_(std::move(server)), reader_(std::move(reader)), radius_m_(radius_m)
    {
        come();
    }

    /// Serves for at least `time`. The object stays at its place, which is sent 250 times a second
    /// unless it rests.
    void serve(std::chrono::milliseconds time, bool rests = false)
    {
        const auto end = Clock::now() + time;
        do
        {
            server_->wait(1ms);
            if (!rests && Clock::now() - moved_ >= 4ms)
            {
                put(at_m_);
            }
            server_->step();
            reader_->poll();
        } while (Clock::now() < end && !is_stop_requested());
    }
    /// Moves to the intended place at the speed of a hand.
    void go_home()
    {
        while (at_m_.norm() > 1e-6 && !is_stop_requested())
        {
            const double left_m = at_m_.norm();
            put(at_m_ * (1.0 - std::min(4e-4, left_m) / left_m));
            serve(4ms);
        }
    }
    void put(const Vec3& at_m)
    {
        at_m_ = at_m;
        moved_ = Clock::now();
        jitter_m_ = jitter_m_ > 0.0 ? 0.0 : 1e-7; // A pose equal to the last one is not sent.
        shown_.pose.translation_m = {at_m.x() + jitter_m_, at_m.y(), at_m.z()};
        static_cast<void>(server_->objects().move(number_, shown_.pose));
    }
    void feel(const Material& material)
    {
        static_cast<void>(server_->objects().feel(number_, material));
    }
    void go() { server_->objects().remove(number_); }
    void come()
    {
        shown_.name = "toy";
        shown_.model = server_->models()[0].store().hash();
        number_ = server_->objects().show(shown_).value();
        ++generation_;
    }
    [[nodiscard]] Hand hand() const
    {
        Hand hand;
        if (reader_->controllers().empty())
        {
            return hand;
        }
        const Telemetry& said = reader_->controllers().front().telemetry;
        if (said.tool_count == 0 || said.pair_count == 0)
        {
            return hand;
        }
        const Vec3 away = vec3(said.tools[0].position_m) - vec3(said.pairs[0].point_m);
        hand.is_there = away.norm() > 0.0;
        hand.touches = said.tools[0].in_contact;
        hand.gap_m = said.pairs[0].lower_m - radius_m_;
        hand.away = hand.is_there ? Vec3(away.normalized()) : hand.away;
        return hand;
    }
    [[nodiscard]] const Vec3& at_m() const { return at_m_; }
    [[nodiscard]] dds::DdsServer& server() { return *server_; }
    [[nodiscard]] std::uint32_t number() const { return number_; }
    [[nodiscard]] std::uint32_t generation() const { return generation_; }

private:
    std::unique_ptr<dds::DdsServer> server_;
    std::unique_ptr<dds::TelemetryReader> reader_;
    double radius_m_;
    ShownObject shown_;
    std::uint32_t number_{0};
    std::uint32_t generation_{0};
    Vec3 at_m_{0.0, 0.0, 0.0};
    double jitter_m_{0.0};
    Clock::time_point moved_{};
};

/// Attack step, called after each received sample; returns true if it attacked.
using Turn = std::function<bool(LyingServer& self, std::uint64_t turn)>;
using Attack = std::function<Turn(LyingServer& self, double number)>;

/// Moves towards a tool that is 0.2 to 4 mm away; between poses, and after a rest.
Turn strike(double way_m)
{
    return [=](LyingServer& self, std::uint64_t turn)
    {
        Hand hand = self.hand();
        if (!hand.is_there || hand.touches || hand.gap_m < 2e-4 || hand.gap_m > 4e-3)
        {
            return false;
        }
        if (turn % 2 != 0)
        {
            self.serve(60ms, true);
            hand = self.hand();
        }
        self.put(self.at_m() + way_m * hand.away);
        self.serve(150ms);
        self.go_home();
        return true;
    };
}

/// Moves with the hand on it, against it and away.
Turn drag(double speed_m_per_s)
{
    return [=](LyingServer& self, std::uint64_t turn)
    {
        const Hand hand = self.hand();
        if (!hand.touches)
        {
            return false;
        }
        const double side = turn % 2 == 0 ? 1.0 : -1.0;
        for (int i = 0; i < 50 && !is_stop_requested(); ++i)
        {
            self.put(self.at_m() + side * speed_m_per_s * 4e-3 * hand.away);
            self.serve(4ms);
        }
        self.go_home();
        self.serve(200ms);
        return true;
    };
}

/// Changes the material every 60 ms.
Turn change_materials()
{
    return [](LyingServer& self, std::uint64_t turn)
    {
        if (!self.hand().touches)
        {
            return false;
        }
        static const std::array<Material, 5> kMaterials{{
            {kInfinity, 0.0, 0.0, 20.0, 0.0},
            {3'000.0, 3.0, 3.0, 0.0, 20.0},
            {50.0, 0.0, 0.0, 0.0, 0.0},
            {kInfinity, 900.0, 0.0, 1e6, 1e6},
            {kInfinity, 0.0, 0.0, 0.0, 0.0, 6e-4, 0.03},
        }};
        self.feel(kMaterials.at(turn % kMaterials.size()));
        self.serve(60ms);
        return true;
    };
}

/// Adds and removes the object under the hand, five times a second.
Turn come_and_go()
{
    return [](LyingServer& self, std::uint64_t)
    {
        if (!self.hand().is_there)
        {
            return false;
        }
        self.go();
        self.serve(100ms, true);
        self.come();
        self.serve(200ms, true);
        return true;
    };
}

/// Swings by 1 mm, with false time stamps.
Turn lie_about_the_time(LyingServer& self)
{
    auto motion = std::make_shared<dds::Endpoint>(
        dds::make_writer(self.server().domain(), dds::Topic::motion,
                         dds::server_partition(self.server().epoch()))
            .value());
    return [motion](LyingServer& liar, std::uint64_t turn)
    {
        static constexpr std::array<std::int64_t, 6> kTimes{
            std::numeric_limits<std::int64_t>::min(),
            std::numeric_limits<std::int64_t>::max(),
            0,
            -1,
            std::numeric_limits<std::int64_t>::max() - 1,
            1};
        tactus_v5_MovedObject moved = {};
        moved.object = liar.number();
        moved.generation = liar.generation();
        moved.pose.rotation[3] = 1.0;
        moved.pose.translation_m[0] = turn % 2 == 0 ? 1e-3 : 0.0;
        moved.pose.scale = 1.0;
        tactus_v5_Motion sample = {};
        sample.server_epoch = liar.server().epoch();
        sample.serial = 1'000'000'000 + turn;
        sample.server_time_ns = kTimes.at(turn / 3 % kTimes.size());
        sample.objects = 1;
        sample.moved = {1, 1, &moved, false};
        dds_write(motion->handle, &sample);
        liar.serve(4ms, true);
        return true;
    };
}

const std::map<std::string, Attack>& attacks()
{
    static const std::map<std::string, Attack> all{
        {"honest", [](LyingServer&, double)
         { return [](LyingServer& self, std::uint64_t) { return self.hand().touches; }; }},
        {"strike", [](LyingServer&, double way_m) { return strike(way_m); }},
        {"drag", [](LyingServer&, double speed) { return drag(speed); }},
        {"materials", [](LyingServer&, double) { return change_materials(); }},
        {"come_and_go", [](LyingServer&, double) { return come_and_go(); }},
        {"clock", [](LyingServer& self, double) { return lie_about_the_time(self); }},
    };
    return all;
}

} // namespace

int main(int argc, char** argv)
{
    const auto attack = argc >= 5 ? attacks().find(argv[4]) : attacks().end();
    if (attack == attacks().end())
    {
        std::fprintf(stderr, "lying_server DOMAIN MODEL RADIUS_M ATTACK [NUMBER]; attacks:");
        for (const auto& [name, unused] : attacks())
        {
            std::fprintf(stderr, " %s", name.c_str());
        }
        std::fprintf(stderr, "\n");
        return 3;
    }
    stop_on_signals();
    auto store = ModelStore::open(argv[2]);
    if (!store)
    {
        std::fprintf(stderr, "lying_server: %s\n", store.error().text.c_str());
        return 2;
    }
    std::vector<dds::PublishedModel> models;
    models.push_back({"toy", std::move(store).value()});
    auto server = dds::DdsServer::create(static_cast<std::uint32_t>(std::atoi(argv[1])),
                                         std::move(models), {}, "toy");
    if (!server)
    {
        std::fprintf(stderr, "lying_server: %s\n", server.error().text.c_str());
        return 2;
    }
    auto reader = dds::TelemetryReader::create(server.value()->domain());
    if (!reader)
    {
        std::fprintf(stderr, "lying_server: %s\n", reader.error().text.c_str());
        return 2;
    }
    LyingServer self(std::move(server).value(), std::move(reader).value(), std::atof(argv[3]));
    std::printf("ready on DDS domain\n");
    std::fflush(stdout);
    const Turn turn = attack->second(self, argc > 5 ? std::atof(argv[5]) : 0.0);
    std::uint64_t turns = 0;
    while (!is_stop_requested())
    {
        self.serve(1ms);
        turns += turn(self, turns) ? 1U : 0U;
    }
    std::printf("done %llu times\n", static_cast<unsigned long long>(turns));
    return 0;
}
