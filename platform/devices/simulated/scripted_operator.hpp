// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/contact_slide.hpp"
#include "platform/devices/simulated/landing_sites.hpp"
#include "platform/devices/simulated/operator_motion.hpp"
#include "platform/devices/simulated/operator_pace.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <memory>
#include <vector>

// create() allocates; call it before the loop. Threads of all else: see OperatorMotion.
namespace tactus
{

/// Model, of any shape, and run for which a simulated operator is made.
struct OperatorScene
{
    /// Points on the surface, for instance the vertices of the coarse mesh; world frame, metres.
    std::vector<Vec3> anchors_world_m;
    double diagonal_m{0.0};        ///< Diagonal of the model's bounding box, in the world.
    double tool_radius_m{0.0};     ///< Tool radius, above 0, up to the diagonal.
    Duration period;               ///< Time between decisions.
    std::uint64_t frames_total{0}; ///< Frames of the run; the script retreats in the last of them.
    bool lifts_off{true};          ///< True: lifts off at times while it slides.
    /// Number of earlier hands on the same model; each begins at another place.
    std::size_t operators_before{0};
};

enum class OperatorPhase
{
    flight,    ///< Flight around the model, at up to two diagonals a second.
    approach,  ///< Straight path to a landing site, slow near its end.
    slide,     ///< Contact, at a tenth of a diagonal a second.
    lift,      ///< Lift off the surface along the last normal, by three tool radii.
    come_back, ///< Return to above the last place of contact, after sliding over an edge.
    descend,   ///< Descent along the last normal to the last place of contact.
    back_off,  ///< Return to the gate, then to the next site, after a failed search.
    retreat    ///< Departure from the model at the end of the run.
};

/// The default script: free flight, approach, slide with lift-offs, retreat. The hand finds its way
/// by the felt force, on any model. A run of 3 s or more at 1 kHz has at least three lift-offs. The
/// hand is then in contact in about two thirds of all frames or more.
///
/// Every phase requests a velocity; the hand follows with limited acceleration, so its path is
/// smooth. The state machine counts frames, and uses arithmetic and square roots only. So the same
/// inputs give the same bits.
class ScriptedOperator final : public OperatorMotion
{
public:
    /// Refuses a scene without anchors, with values that are not finite, with a diagonal or a tool
    /// radius that is not positive, a tool larger than the model, a period that is not positive.
    [[nodiscard]] static Result<std::unique_ptr<ScriptedOperator>, Refusal>
    create(const OperatorScene& scene);

    [[nodiscard]] Vec3 start_world_m() const noexcept override { return start_world_m_; }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override;

    [[nodiscard]] OperatorPhase phase() const noexcept { return phase_; }
    /// Centre of a workspace that contains the whole script, with radius reach_m().
    [[nodiscard]] const Vec3& centre_world_m() const noexcept { return centre_world_m_; }
    [[nodiscard]] double reach_m() const noexcept;

private:
    explicit ScriptedOperator(const OperatorScene& scene);

    [[nodiscard]] Vec3 target(const OperatorSense& sense) noexcept;
    [[nodiscard]] Vec3 fly() noexcept;
    [[nodiscard]] Vec3 approach(const OperatorSense& sense) noexcept;
    [[nodiscard]] Vec3 slide(const OperatorSense& sense) noexcept;
    [[nodiscard]] Vec3 lift(const OperatorSense& sense) noexcept;
    [[nodiscard]] Vec3 come_back() noexcept;
    [[nodiscard]] Vec3 descend(const OperatorSense& sense) noexcept;
    [[nodiscard]] Vec3 back_off() noexcept;
    [[nodiscard]] Vec3 retreat() noexcept;

    /// Place where the surface was felt, shortly before contact may have been lost.
    struct Place
    {
        Vec3 point_world_m{Vec3::Zero()};
        Vec3 normal{Vec3::UnitZ()};
        Vec3 heading{Vec3::UnitX()};
    };

    void enter(OperatorPhase phase) noexcept;
    void lose_contact() noexcept;
    void update_touch(const OperatorSense& sense) noexcept;
    [[nodiscard]] bool meets(const OperatorSense& sense, const Vec3& way) const noexcept;
    void land(const OperatorSense& sense, const Vec3& heading_hint) noexcept;
    void remember_place(const OperatorSense& sense) noexcept;
    [[nodiscard]] Place place_here(const OperatorSense& sense) const noexcept;
    void move_towards(const Vec3& commanded_m_per_s) noexcept;
    void stay_near_device(const OperatorSense& sense) noexcept;
    [[nodiscard]] const LandingSite& site() const noexcept { return sites_[site_]; }
    [[nodiscard]] double seconds_in_phase() const noexcept;

    double diagonal_m_;
    double tool_radius_m_;
    double period_s_;
    OperatorPace pace_;
    OperatorSchedule schedule_;
    std::uint64_t place_spacing_frames_;
    Vec3 centre_world_m_;
    std::vector<LandingSite> sites_;
    Vec3 start_world_m_;

    OperatorPhase phase_{OperatorPhase::flight};
    std::uint64_t frames_in_phase_{0};
    Vec3 position_world_m_;
    Vec3 velocity_m_per_s_{Vec3::Zero()};
    std::size_t site_{0};
    Vec3 approach_direction_{Vec3::Zero()};
    double felt_s_{0.0}; ///< Duration of the uninterrupted force in this phase.
    ContactSlide slide_;
    /// Place 64 to 128 ms ago; not changed by a landing until the landing is sure.
    Place place_;
    Place newest_place_; ///< Place up to 64 ms ago.
    OperatorPhase landed_from_{OperatorPhase::approach};
    bool is_landing_sure_{false};
    Vec3 released_world_m_{Vec3::Zero()};
    bool released_{false};
    std::uint32_t lift_offs_{0}; ///< Number of lift-offs that reached the full height.
    std::uint32_t losses_{0};
    bool landed_{false};
};

} // namespace tactus
