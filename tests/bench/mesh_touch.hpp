// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/mesh_query.hpp"
#include "tests/bench/peers/pair_query.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/shared/face_names.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::bench
{

/// Mesh tool: a bumpy sphere of about 1,000 faces around the origin of its frame.
enum class MeshProbe : std::uint8_t
{
    large, ///< Longest side: 0.15 of an object's diagonal.
    small, ///< Diagonal: 0.15 of an object's diagonal.
};
/// Skin of a mesh tool, in diagonals of the object.
inline constexpr double kMeshSkin_diag = 0.001;
[[nodiscard]] NamedMesh make_tool_mesh(const Scene& object, MeshProbe probe);

/// Faces of a scene in the frame of its source mesh.
[[nodiscard]] std::vector<Triangle> faces_in_source_frame(const Scene& scene);
/// Faces of a scene in the model frame, which all contestants use.
[[nodiscard]] std::vector<Triangle> faces_in_model_frame(const Scene& scene);

/// Poses of a tool that rotates at 1 rad/s about one axis, above or below the surface point nearest
/// to the centre of a path, along the direction between the two.
///
/// The large tool slides over the object at 0.1 diag/s; its lowest corner moves between 0.75 % of
/// the diagonal below the surface point and 0.5 % above it once a second. The small one flies,
/// approaches, slides and retreats (touch_motion); its lowest corner has the height of the lowest
/// point of that motion's sphere.
[[nodiscard]] std::vector<Similarity> mesh_touch_motion(const TouchScene& object,
                                                        const std::vector<Triangle>& tool,
                                                        MeshProbe probe, std::uint32_t frames);

/// Queries of two meshes over two static models.
class TactusPairQuery final : public PairQuery
{
public:
    TactusPairQuery(const Scene& tool, const Scene& object);

    [[nodiscard]] std::string name() const override { return "Tactus"; }
    void place(const Similarity& tool) override;
    [[nodiscard]] bool do_meet() override;
    /// Meeting pairs; those with the lowest ids if there are more than kMaxMeetingFaces.
    [[nodiscard]] const std::vector<test::FacePair>& meeting() override;
    /// The frame's question: contacts within the skin and those at the ends of the support, as the
    /// force needs them.
    [[nodiscard]] const std::vector<test::FacePair>& contacts() override;
    /// NaN when the answer is not proven to rounding.
    [[nodiscard]] double distance_m() override;
    [[nodiscard]] test::FacePair in_source(const test::FacePair& own) const override;
    void forget() override;

private:
    [[nodiscard]] MeshQuestion question();
    void find_meeting(std::uint32_t enough);
    [[nodiscard]] const std::vector<test::FacePair>& pairs_of_report();
    StaticModel tool_;
    StaticModel object_;
    test::FaceNames tool_names_;
    test::FaceNames object_names_;
    MeshPlacement place_;
    MeshMemory memory_;
    PairFront front_;
    DistanceAnswer answer_;
    MeshReport report_;
    double skin_m_;
    ContactReport contacts_;
    ContactEnds ends_;
    std::vector<test::FacePair> pairs_;
};

} // namespace tactus::bench
