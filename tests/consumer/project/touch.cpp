// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// touch FILE, or touch NAME DOMAIN: a pen, held by a device of its own, between two objects that
// move. The model comes from a file, or over DDS from whoever publishes it. Prints what was felt
// and a digest over every bit of the answers: from a file it is the same whatever this program was
// compiled with.
#include <array>
#include <bit>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <tactus/platform/haptic_device.hpp>
#include <tactus/rt_core/force/force_conditioner.hpp>
#include <tactus/rt_core/force/own_force.hpp>
#include <tactus/rt_core/force/safe_state.hpp>
#include <tactus/rt_core/frame/frame.hpp>
#include <tactus/transport/courier.hpp>
#include <tactus/transport/dds/dds_client.hpp>
#include <tactus/transport/store/store_link.hpp>
#include <thread>

using namespace tactus;

namespace
{

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr std::uint64_t kFrames = 2'000;

/// A device of one's own: here a hand that goes down 60 mm in two seconds, and gives way to the
/// force by 0.2 mm a newton.
class DescendingHand final : public HapticDevice
{
public:
    explicit DescendingHand(const Vec3& start_m) : start_m_(start_m)
    {
        info_.name = "descending hand";
        info_.workspace_radius_m = 0.2;
        info_.speed_max_m_per_s = 1.0;
        info_.rate_min_hz = 1'000;
        info_.rate_max_hz = 1'000;
    }

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] DeviceSample read() noexcept override
    {
        DeviceSample sample;
        const double share = static_cast<double>(status_.frames) / static_cast<double>(kFrames);
        const Vec3 place_m = start_m_ - Vec3(0.0, 0.0, 0.06 * share) + 2e-4 * force_n_;
        sample.position_world_m = {place_m.x(), place_m.y(), place_m.z()};
        sample.frame = status_.frames++;
        sample.valid = true;
        return sample;
    }
    void write(const Wrench& wrench) noexcept override
    {
        const std::array<double, 3>& n = wrench.force_world_n;
        const bool is_free = status_.state != DeviceState::brake;
        force_n_ = is_free ? Vec3(n[0], n[1], n[2]) : Vec3(0.0, 0.0, 0.0);
        status_.state = is_free ? DeviceState::force : DeviceState::brake;
    }
    void brake() noexcept override { status_.state = DeviceState::brake; }
    void release_brake() noexcept override { status_.state = DeviceState::idle; }
    [[nodiscard]] DeviceStatus status() const noexcept override { return status_; }

private:
    DeviceInfo info_;
    DeviceStatus status_;
    Vec3 start_m_;
    Vec3 force_n_{0.0, 0.0, 0.0};
};

/// FNV-1a over the bits of doubles.
class Digest
{
public:
    void add(double value)
    {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (unsigned shift = 0; shift < 64; shift += 8)
        {
            hash_ = (hash_ ^ ((bits >> shift) & 0xFFU)) * 0x100'0000'01B3U;
        }
    }
    void add(const Vec3& value)
    {
        add(value.x());
        add(value.y());
        add(value.z());
    }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_{0xCBF2'9CE4'8422'2325U};
};

int fail(const char* text)
{
    std::fprintf(stderr, "touch: %s\n", text);
    return 2;
}

/// Both objects are the same model, one above the other; the upper turns, the lower goes sideways.
SceneChange move(std::uint32_t object, std::uint64_t frame)
{
    const double seconds = 1e-3 * static_cast<double>(frame);
    SceneChange change;
    change.kind = SceneChangeKind::object_moves;
    change.number = object;
    if (object == 0)
    {
        change.pose.rotation =
            Eigen::AngleAxisd(0.3 * seconds, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    }
    else
    {
        change.pose.translation_m = {0.01 * seconds, 0.0, -0.03};
    }
    return change;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 2 || argc > 3)
    {
        std::fprintf(stderr, "usage: touch FILE | touch NAME DOMAIN\n");
        return 3;
    }
    std::unique_ptr<dds::DdsClient> client; // Must outlive the model's link.
    Result<ServedModel, Refusal> served = Refusal{};
    if (argc == 2)
    {
        served = serve_from_file(argv[1], "ring", {});
    }
    else
    {
        const auto domain = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
        auto joined = dds::DdsClient::create(domain, "touch", {});
        if (!joined)
        {
            return fail(joined.error().text.c_str());
        }
        client = std::move(joined).value();
        served = client->find({argv[1], {}}, std::chrono::seconds(10));
    }
    if (!served)
    {
        return fail(served.error().text.c_str());
    }
    const ServedModel& model = served.value();
    const ModelHeader header = ModelHeader::parse(model.header).value();

    // A tool of one's own: a pen of 30 mm, 2 mm thick, that is held upright.
    ToolSpec pen;
    pen.core = Segment{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.03}};
    pen.radius_m = 0.001;
    pen.wants_contacts = true;
    const std::array<ToolSpec, 1> tools{pen};
    const std::array<ObjectSpec, 2> objects{ObjectSpec{ModelId{0}}, ObjectSpec{ModelId{0}}};
    const std::array<ObjectPose, 2> poses{move(0, 0).pose, move(1, 0).pose};

    constexpr std::size_t kBytes = std::size_t{4} << 20U;
    const auto memory = std::make_unique<std::byte[]>(kBytes + Arena::kAlignment);
    void* first = memory.get();
    std::size_t room = kBytes + Arena::kAlignment;
    std::align(Arena::kAlignment, kBytes, first, room);
    Arena arena({static_cast<std::byte*>(first), kBytes});

    const std::array<ModelSource, 1> sources{
        ModelSource{model.header, model.base, plan_capacities(header, kBytes / 2, 0)}};
    FrameSetup setup;
    setup.tools = tools;
    setup.objects = objects;
    setup.poses = poses;
    setup.models = sources;
    setup.period_ns = kPeriod_ns;
    std::optional<Frame> frame;
    if (const auto started = Frame::start(frame, arena, setup); !started)
    {
        return fail(refusal_text(started.error()));
    }
    Model& parts = frame->model({0});
    Courier courier(arena, frame->pools().slots, frame->pools().cache.door, {});
    courier.add(parts.header, parts.linker, *model.link, model.name);

    DescendingHand device(Vec3(0.028, 0.0, 0.03));
    ConditionerSetup limits;
    limits.device = device.info().limits;
    limits.period_s = 1e-9 * static_cast<double>(kPeriod_ns);
    WrenchConditioner conditioner(limits);
    const Vec3 middle_m(0.028, 0.0, 0.0);
    SafeState safe({1.0, pen.force_max_n, pen.stiffness_n_per_m, 0.0, pen.torque_max_nm});
    Digest digest;
    std::uint32_t touched = 0;
    std::uint32_t contacts = 0;
    std::uint32_t exact = 0;
    std::uint32_t wrong = 0;
    for (std::uint64_t i = 0; i < kFrames; ++i)
    {
        const DeviceSample sample = device.read();
        ToolState state;
        state.position_m = {sample.position_world_m[0], sample.position_world_m[1],
                            sample.position_world_m[2]};
        state.valid = sample.valid;
        const std::array<SceneChange, 2> changes{move(0, i), move(1, i)};
        courier.step(static_cast<std::int64_t>(i) * kPeriod_ns);
        const FrameOutput output =
            frame->run({.tools = {&state, 1}, .changes = changes, .budgets = {}, .now_ns = 0});

        const ToolOutput& felt = output.tools[0];
        WrenchWish wish;
        wish.force = {felt.force_n, state.position_m, felt.stiffness_n_per_m,
                      (felt.proxy_m - state.position_m).norm()};
        // A spring of 50 N/m guides the pen towards a point, with 1 N at most.
        const OwnForce guide = spring_to(middle_m, state.position_m, 50.0, 1.0);
        const ConditionedWrench wrench = conditioner.condition(with_own(wish, guide));

        SafetyInput input;
        input.position_m = state.position_m;
        input.elapsed_s = 1e-9 * static_cast<double>(kPeriod_ns);
        input.force_n = wrench.force.force_n;
        input.proxy_m = felt.proxy_m;
        input.faults = faults_of(felt);
        const SafetyOutput out = safe.step(input);
        conditioner.follow(out.force_n, out.torque_nm);
        device.write({{out.force_n.x(), out.force_n.y(), out.force_n.z()}, {}, 0.0});

        digest.add(out.force_n);
        digest.add(out.torque_nm);
        digest.add(felt.proxy_m);
        for (const PairOutput& pair : output.pairs)
        {
            digest.add(pair.lower_m);
            digest.add(pair.upper_m);
            digest.add(pair.nearest_point_m);
            exact += pair.kind == AnswerKind::exact ? 1 : 0;
            wrong += pair.lower_m > pair.upper_m ? 1 : 0;
            contacts += pair.contacts != nullptr && pair.contacts->contacts.size() > 0 ? 1 : 0;
        }
        touched += felt.in_contact ? 1 : 0;
        if (client)
        {
            std::this_thread::sleep_for(std::chrono::nanoseconds(kPeriod_ns));
        }
    }
    std::printf("touched in %u frames, %u exact answers, %u reports of contacts, digest %016llx\n",
                touched, exact, contacts, static_cast<unsigned long long>(digest.value()));
    return touched > 0 && exact > 0 && contacts > 0 && wrong == 0 ? 0 : 1;
}
