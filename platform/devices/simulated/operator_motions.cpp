// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/operator_motions.hpp"

#include "platform/devices/simulated/landed_operator.hpp"
#include "platform/devices/simulated/landing_sites.hpp"
#include "platform/devices/simulated/motion_maths.hpp"
#include "platform/devices/simulated/rotating_operators.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

constexpr std::string_view kNames[] = {"script", "free",   "approach", "slide", "tap", "teleport",
                                       "spin",   "tremor", "turn",     "edge",  "peg"};

/// Least distance from a hand's start to the workspace's end, in diagonals.
constexpr double kRoom_diag = 0.05;

/// Circles around the model through a landing site's gate, without contact.
class FlyingOperator final : public OperatorMotion
{
public:
    explicit FlyingOperator(const OperatorScene& scene)
        : centre_world_m_(centre_of(scene.anchors_world_m))
        , first_m_(find_landing_sites(scene.anchors_world_m, scene.diagonal_m, scene.tool_radius_m,
                                      scene.operators_before)
                       .front()
                       .gate_world_m -
                   centre_world_m_)
        , second_m_(any_across(first_m_) * first_m_.norm())
        , phasor_(kTurnsPerSecond, to_seconds(scene.period))
    {
    }
    [[nodiscard]] Vec3 start_world_m() const noexcept override
    {
        return centre_world_m_ + first_m_;
    }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& /*sense*/) noexcept override
    {
        phasor_.turn();
        return centre_world_m_ + first_m_ * phasor_.cos() + second_m_ * phasor_.sin();
    }

private:
    static constexpr double kTurnsPerSecond = 0.25;

    Vec3 centre_world_m_;
    Vec3 first_m_;
    Vec3 second_m_;
    Phasor phasor_;
};

/// Jumps between the gates and the aims of the landing sites, in an order that the seed determines.
class JumpingOperator final : public OperatorMotion
{
public:
    JumpingOperator(const OperatorScene& scene, std::uint64_t seed)
        : frames_between_(OperatorSchedule::frames_in(kRest_s, to_seconds(scene.period)) + 1)
        , seed_(seed)
    {
        for (const LandingSite& site :
             find_landing_sites(scene.anchors_world_m, scene.diagonal_m, scene.tool_radius_m,
                                scene.operators_before))
        {
            places_world_m_.push_back(site.gate_world_m);
            places_world_m_.push_back(site.aim_world_m);
        }
    }
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return places_world_m_.front(); }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override
    {
        const std::uint64_t jumps = sense.frame / frames_between_;
        const std::uint64_t place = mix_bits(mix_bits(seed_) ^ jumps) % places_world_m_.size();
        return jumps == 0 ? places_world_m_.front() : places_world_m_[place];
    }

private:
    static constexpr double kRest_s = 0.5;

    std::uint64_t frames_between_;
    std::uint64_t seed_;
    std::vector<Vec3> places_world_m_;
};

/// Adds tremor to another motion: on each axis three oscillations between 8 and 12 Hz, of up to 0.2
/// mm each. The seed determines frequencies and sizes; the tremor starts at zero.
class TremblingOperator final : public OperatorMotion
{
public:
    TremblingOperator(std::unique_ptr<OperatorMotion> motion, double period_s, std::uint64_t seed)
        : motion_(std::move(motion))
    {
        for (std::uint64_t i = 0; i < swings_.size(); ++i)
        {
            const double turns_per_s = kMiddle_hz + kHalfBand_hz * noise_at(seed, 2 * i);
            swings_[i] = {Phasor(turns_per_s, period_s),
                          kSize_m * (0.75 + 0.25 * noise_at(seed, 2 * i + 1))};
        }
    }
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return motion_->start_world_m(); }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override
    {
        Vec3 place_m = motion_->next_world_m(sense);
        for (std::size_t i = 0; i < swings_.size(); ++i)
        {
            swings_[i].phasor.turn();
            place_m[static_cast<int>(i % 3)] += swings_[i].size_m * swings_[i].phasor.sin();
        }
        return place_m;
    }

private:
    static constexpr double kMiddle_hz = 10.0;
    static constexpr double kHalfBand_hz = 2.0;
    static constexpr double kSize_m = 2e-4;

    struct Swing
    {
        Phasor phasor;
        double size_m{0.0};
    };

    std::unique_ptr<OperatorMotion> motion_;
    std::array<Swing, 9> swings_; ///< Oscillation i acts on axis i % 3.
};

std::unique_ptr<OperatorMotion> make_motion_of(MotionKind kind, const OperatorScene& scene,
                                               std::uint64_t seed,
                                               std::unique_ptr<ScriptedOperator> script)
{
    switch (kind)
    {
    case MotionKind::free:
        return std::make_unique<FlyingOperator>(scene);
    case MotionKind::approach:
        return std::make_unique<PressingOperator>(scene);
    case MotionKind::tap:
        return std::make_unique<TappingOperator>(scene);
    case MotionKind::teleport:
        return std::make_unique<JumpingOperator>(scene, seed);
    case MotionKind::spin:
        return std::make_unique<SpinningOperator>(scene);
    case MotionKind::tremor:
        return std::make_unique<TremblingOperator>(std::move(script), to_seconds(scene.period),
                                                   seed);
    case MotionKind::turn:
        return std::make_unique<RotatingOperator>(scene);
    case MotionKind::edge:
        return std::make_unique<EdgeOperator>(std::move(script), scene);
    case MotionKind::peg:
        return std::make_unique<PegOperator>(scene);
    case MotionKind::script:
    case MotionKind::slide:
        break;
    }
    return script;
}

} // namespace

std::optional<MotionKind> motion_named(std::string_view name)
{
    const auto* const found = std::ranges::find(kNames, name);
    return found != std::end(kNames)
               ? std::optional(static_cast<MotionKind>(found - std::begin(kNames)))
               : std::nullopt;
}

Result<MadeMotion, Refusal> make_motion(MotionKind kind, const OperatorScene& scene,
                                        std::uint64_t seed)
{
    OperatorScene played = scene;
    played.lifts_off = kind != MotionKind::slide && kind != MotionKind::edge;
    auto script = ScriptedOperator::create(played); // This checks the scene for all motions.
    if (!script)
    {
        return script.error();
    }
    MadeMotion made;
    made.centre_world_m = script.value()->centre_world_m();
    made.reach_m = script.value()->reach_m();
    made.motion = make_motion_of(kind, played, seed, std::move(script).value());
    const double start_m = (made.motion->start_world_m() - made.centre_world_m).norm();
    made.reach_m = std::max(made.reach_m, start_m + kRoom_diag * scene.diagonal_m);
    return made;
}

} // namespace tactus
