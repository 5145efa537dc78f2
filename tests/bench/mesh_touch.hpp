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

/// A tool that is a mesh: a bumpy sphere of about 1,000 faces round the origin of its frame.
enum class MeshProbe : std::uint8_t
{
    large, ///< Its longest side is 0.15 of an object's diagonal.
    small, ///< Its diagonal is.
};
/// Of a tool that is a mesh, in diagonals of the object.
inline constexpr double kMeshSkin_diag = 0.001;
[[nodiscard]] NamedMesh make_tool_mesh(const Scene& object, MeshProbe probe);

/// The faces of a scene in the frame of the mesh that it was made of.
[[nodiscard]] std::vector<Triangle> faces_in_source_frame(const Scene& scene);
/// In the model's frame, as every contestant has the object.
[[nodiscard]] std::vector<Triangle> faces_in_model_frame(const Scene& scene);

/// Places of a tool that turns at 1 rad/s about one axis, and stands above or in the point of the
/// surface that is nearest to a way's centre, along the direction between the two.
///
/// The large tool slides over the object at 0.1 diag/s, its lowest corner between 0.75 % of the
/// diagonal below the surface's point and 0.5 % above it, there and back once a second. The small
/// one flies, approaches, slides and retreats (touch_motion); its lowest corner is as high as the
/// lowest point of that motion's sphere.
[[nodiscard]] std::vector<Similarity> mesh_touch_motion(const TouchScene& object,
                                                        const std::vector<Triangle>& tool,
                                                        MeshProbe probe, std::uint32_t frames);

/// The controller's queries of two meshes over two static models.
class TactusPairQuery final : public PairQuery
{
public:
    TactusPairQuery(const Scene& tool, const Scene& object);

    [[nodiscard]] std::string name() const override { return "Tactus"; }
    void place(const Similarity& tool) override;
    [[nodiscard]] bool do_meet() override;
    /// Those with the lowest ids when there are more than kMaxMeetingFaces.
    [[nodiscard]] const std::vector<test::FacePair>& meeting() override;
    /// The frame's question, with contacts within the skin and those at the
    /// ends of what the tool lies on, as the force needs them.
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
