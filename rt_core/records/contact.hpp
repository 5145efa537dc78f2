// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Contact of a tool with a face of an object: the face is within the radius of the core, or of a
/// face of a mesh tool. Frame and unit are those of the structure that holds the contact.
struct Contact
{
    FaceId face{};
    TriangleFeature feature{TriangleFeature::interior}; ///< Nearest feature of the face.
    double distance_m{0.0};                             ///< Distance of the face from the core.
    Vec3 on_tool_m{0.0, 0.0, 0.0};                      ///< Nearest point of the core.
    Vec3 on_surface_m{0.0, 0.0, 0.0};
    /// Unit vector from the surface to the core. If the two meet, the normal of the face, or zero
    /// for a face without area.
    Vec3 normal{0.0, 0.0, 0.0};
    FaceId tool_face{}; ///< Face of a mesh tool; none for other tools.
};

/// Contacts, nearest first. Equally near ones are in order of the object's face ids, then of the
/// tool's face ids.
using ContactSet = StaticVector<Contact, kMaxContacts>;

/// Group of faces with similar normals. Each face lies behind a plane of its own, and the core is
/// at least `distance_m` in front of that plane.
struct ContactSlab
{
    Vec3 normal{0.0, 0.0, 0.0}; ///< Unit length, from the surface to the core.
    double distance_m{0.0};
    /// Largest length of the difference between `normal` and the unit normal of a plane.
    double spread{0.0};
};
/// Largest number of slabs of one pair, 40 B each. Further faces join the slab with the most
/// similar normal, whose spread grows.
inline constexpr std::size_t kMaxSlabs = 16;

/// Number of directions in which the farthest contact is kept: 6 along the axes, 12 between two
/// axes, 8 between three.
inline constexpr std::size_t kContactDirections = 26;

/// Farthest contact in each direction, so that a rigid tool on hundreds of faces is held at the
/// ends of its support. The reach of a contact is its height along the direction, less ten times
/// its distance from the core. So contacts count that would touch after a rotation by a tenth of a
/// radian. A mesh tool measures at most one pair of faces for each direction, beyond the contacts
/// that it keeps.
struct ContactEnds
{
    std::array<Contact, kContactDirections> contacts{};
    std::array<double, kContactDirections> reaches_m{};
    bool is_empty{true};
};

/// Possible contacts of a rigid tool with one object, for the force stage. 10 KiB.
struct TouchReport
{
    ContactSet nearest;       ///< Contacts at the nearest point of each face.
    ContactSet corners;       ///< Contacts of corners of the core that are over a face.
    ContactEnds ends;         ///< Farthest contacts of all, including those that did not fit above.
    bool is_truncated{false}; ///< True if some contacts did not fit.
    /// Slabs that hold all faces nearer than `covered_m`, if these faces are exact.
    StaticVector<ContactSlab, kMaxSlabs> slabs;
    double covered_m{0.0};

    /// Resets the report without writing unused contacts.
    void clear() noexcept
    {
        nearest.clear();
        corners.clear();
        ends.is_empty = true;
        is_truncated = false;
        slabs.clear();
        covered_m = 0.0;
    }
};

/// Side of a closed surface on which a point lies.
enum class Side : std::uint8_t
{
    unsigned_distance, ///< Mesh open, answer not exact, or point on the surface.
    outside,           ///< The side that the normals point to.
    inside,
};

/// Contacts of one pair, for a tool that wants them (ToolSpec::wants_contacts). World frame and
/// metres in a PairOutput. 3 KiB.
struct ContactReport
{
    ContactSet contacts;
    bool is_complete{false}; ///< True if the report is proven to hold every contact.
    /// Number of faces for which libccd contradicts the proven bounds; 0 unless the core is a
    /// convex body.
    std::uint32_t overruled{0};
    /// Normal of the surface at the nearest point: a face's own, the mean of an edge's faces, or
    /// that of a vertex's faces weighted by their angles. Unit length; zero if unknown.
    Vec3 normal{0.0, 0.0, 0.0};
    Side side{Side::unsigned_distance};

    /// Resets the report without writing unused contacts.
    void clear() noexcept
    {
        contacts.clear();
        is_complete = false;
        overruled = 0;
        normal = Vec3(0.0, 0.0, 0.0);
        side = Side::unsigned_distance;
    }
};

} // namespace tactus
