// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/half_spaces.hpp"
#include "rt_core/force/symmetric_factor.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// Contacts of a rigid tool that friction may hold: each takes four planes of kMaxHalfSpaces.
inline constexpr std::size_t kTiltedContacts = kMaxHalfSpaces / 4;

/// Point where a rigid tool may touch; world frame.
struct BodyTouch
{
    std::uint32_t surface{0}; ///< Index of the step's surface.
    Vec3 on_tool_m{0.0, 0.0, 0.0};
    Vec3 on_surface_m{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 0.0}; ///< Direction from the surface to the tool.
    /// The touch is within a face, whose own normal `normal` is.
    bool is_face{false};
};

/// Material of the surface at a touch.
struct BodyGrip
{
    double stiffness_n_per_m{0.0};
    double friction{0.0}; ///< The coefficient that holds now.
    double dynamic{0.0};  ///< Coefficient while sliding.
    double damping_n_s_per_m{0.0};
    /// Displacement along the surface in this frame, per stretch that resists it.
    double viscous{0.0};
    Vec3 velocity_m_per_s{0.0, 0.0, 0.0}; ///< Velocity of the surface.
    /// Displacement of the surface, in which friction carries the tool.
    Vec3 way_m{0.0, 0.0, 0.0};
    Vec3 frame_way_m{0.0, 0.0, 0.0}; ///< The same in the whole frame.
};

/// A push on a rigid tool: `reaction` x `normal` is the motion that it holds back.
struct BodyPush
{
    std::uint32_t touch{0};
    Motion<6> normal{Motion<6>::Zero()};
    double reaction{0.0};
};

/// The motion of a rigid tool that planes and friction allow, and the pushes at its end.
struct BodyMotion
{
    Motion<6> motion{Motion<6>::Zero()};
    StaticVector<BodyPush, 6> pushes;
    bool slides{false};              ///< Slides against friction.
    bool sticks{false};              ///< Friction holds the tool where it pushes.
    bool is_over_constrained{false}; ///< No motion was allowed by all planes.
};

/// Planes of one step of a rigid tool, and the motion that they and Coulomb's friction allow.
///
/// Motions are six numbers: a displacement in metres, and a rotation vector times the arm. Their
/// length is the coupling's energy, so the nearest motion is where its springs come to rest.
///
/// Friction (Moreau 1966): the plane of a contact is tilted into four, whose normals are the
/// corners of its friction pyramid: normal +- coefficient x tangent, the first tangent along the
/// displacement that the device wants there. The nearest motion that tilted planes allow is zero if
/// the device's pull lies within the cone that they span, all contacts together, and only then: the
/// tool sticks. While the tool slides, tilted planes would lift it; so their friction is added to
/// the wanted motion and the plain planes answer, once more with the friction that belongs to their
/// pressure.
///
/// Viscosity: while the tool slides, each contact that presses is a damper, implicit as in Proxy. A
/// motion then costs the dampers' part of it besides the springs' energy, and the nearest one is
/// found in that metric: the planes and the wanted motion are transformed there and back by its
/// Cholesky factor.
///
/// Seams: if a tool is over one face, the next one seems to lean against it, since its nearest
/// point is the edge that both share. Such a plane would let the tool go at most half of the
/// distance to the edge, and so drag at a sliding tool. It is left out if touches on the first
/// face's plane support that place of the tool from all sides.
///
/// Scratch, too large for a frame's stack: 23 KiB. Haptic thread. Cost: 0.7 to 5 us without
/// friction, at most 10 us more with it.
class BodyPlanes
{
public:
    /// Clears the planes for a step of a tool at `place_m`: `arm_m` is the metric's, `size_m` the
    /// tool's own. `gone` is its motion in the frame's earlier steps.
    void begin(const Vec3& place_m, double arm_m, double size_m, double radius_m,
               const Motion<6>& gone) noexcept TACTUS_NONBLOCKING;
    /// Adds the planes of a touch. If full, the plane that restrains least is dropped, and the
    /// planes are over capacity.
    void add(const BodyTouch& touch, const BodyGrip& grip) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] BodyMotion nearest(const Motion<6>& wanted) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool exceeds_capacity() const noexcept { return exceeds_capacity_; }
    [[nodiscard]] const BodyTouch& touch(std::uint32_t i) const noexcept { return touches_[i]; }
    [[nodiscard]] const BodyGrip& grip(std::uint32_t i) const noexcept { return grips_[i]; }
    /// Lever of a touch: from the tool's place to the point where its outside meets the surface.
    [[nodiscard]] Vec3 lever_m(std::uint32_t i) const noexcept TACTUS_NONBLOCKING;

private:
    /// One corner of a contact's friction pyramid.
    struct Tilt
    {
        std::uint32_t touch{0};
        Motion<6> drag{Motion<6>::Zero()}; ///< Coefficient x tangent.
    };
    using Chosen = StaticVector<std::uint32_t, kTiltedContacts>;

    /// A plane of faces that the tool touches, and the touching part of the tool; a mesh has many
    /// faces in one plane.
    struct Ground
    {
        using Heights = std::array<double, 8>; ///< Heights along directions in the plane.

        std::uint32_t face; ///< Touch of the nearest of these faces.
        Vec3 first;         ///< An axis in the plane.
        Vec3 second;        ///< The other one.
        Heights high_m{};   ///< Ends of the touching points of the tool, from its place.
        Heights low_m{};    ///< Beginnings of the same.

        Ground(std::uint32_t nearest, const Vec3& normal) noexcept;
        [[nodiscard]] Heights heights(const Vec3& point_m) const noexcept;
        void support(const Vec3& point_m) noexcept;
        [[nodiscard]] bool is_among_supports(const Vec3& point_m, double off_m) const noexcept;
    };
    /// Seams of further ones are not left out.
    static constexpr std::size_t kMaxGrounds = 8;
    using Grounds = StaticVector<Ground, kMaxGrounds>;

    [[nodiscard]] Grounds grounds() const noexcept;
    [[nodiscard]] bool is_seam(std::size_t plane, const Ground& ground) const noexcept;
    void leave_out_seams() noexcept;
    void replace(std::size_t plane, const HalfSpace<6>& space, const BodyTouch& touch,
                 const BodyGrip& grip) noexcept;
    [[nodiscard]] double apart_sq(const HalfSpace<6>& a, const HalfSpace<6>& b) const noexcept;
    [[nodiscard]] NearestMotion<6> plain(const Motion<6>& wanted,
                                         bool& is_over_constrained) noexcept;
    [[nodiscard]] Chosen choose(const NearestMotion<6>& plain) const noexcept;
    void tilt(const Chosen& chosen, const Motion<6>& wanted) noexcept;
    void tilt(std::uint32_t touch, const Motion<6>& wanted) noexcept;
    [[nodiscard]] bool is_stuck(const NearestMotion<6>& tilted) const noexcept;
    [[nodiscard]] BodyMotion stuck(const NearestMotion<6>& tilted) noexcept;
    [[nodiscard]] BodyMotion sliding(const NearestMotion<6>& tilted,
                                     const Motion<6>& wanted) noexcept;
    /// Dampers' share of a motion, (metric - 1) x motion, and their share of the earlier motion.
    struct Viscosity
    {
        SymmetricFactor factor; ///< Factor of the metric.
        Motion<6> gone{Motion<6>::Zero()};
    };

    [[nodiscard]] bool drags(const NearestMotion<6>& held, std::size_t i) const noexcept;
    [[nodiscard]] std::optional<Viscosity>
    viscosity_of(const NearestMotion<6>& held) const noexcept;
    void rub(const NearestMotion<6>& held, const Motion<6>& wanted, const Motion<6>& drag,
             BodyMotion& answer) noexcept;
    [[nodiscard]] double share_of(const NearestMotion<6>& plain, double most) const noexcept;

    StaticVector<HalfSpace<6>, kMaxHalfSpaces> spaces_;
    StaticVector<BodyTouch, kMaxHalfSpaces> touches_;
    StaticVector<BodyGrip, kMaxHalfSpaces> grips_;
    StaticVector<HalfSpace<6>, kMaxHalfSpaces> tilted_; ///< Corners of pyramids, then plain ones.
    StaticVector<Tilt, kMaxHalfSpaces> tilts_;          ///< Tilts of the corners in tilted_.
    StaticVector<std::uint32_t, kMaxHalfSpaces> untilted_; ///< Touches of the plain ones.
    Vec3 place_m_{0.0, 0.0, 0.0};
    Motion<6> gone_{Motion<6>::Zero()};
    double arm_m_{1.0};
    /// Weight of rotations when planes are compared: the tool's size is the arm.
    double turn_weight_{1.0};
    double radius_m_{0.0};
    bool exceeds_capacity_{false};
};

} // namespace tactus
