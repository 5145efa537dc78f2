// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/mesh_query.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/peers/all_peers.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/shared/mesh_pair_oracle.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tactus::bench
{

/// Greatest error of our own answers, which are exact to rounding.
inline constexpr double kOurError_diag = 1e-9;

enum class PairQuestion : std::uint8_t
{
    any,
    all_pairs,
    contacts,
    distance,
};
inline constexpr std::array kPairQuestions{PairQuestion::any, PairQuestion::all_pairs,
                                           PairQuestion::contacts, PairQuestion::distance};
[[nodiscard]] const char* question_name(PairQuestion question);

/// Meeting pairs, decided exactly, and the least distance for each pose of the tool. Faces are
/// named by their places in the sources; equal faces by the lowest place.
struct PairTruth
{
    std::vector<std::vector<test::FacePair>> meeting; ///< Ascending.
    std::vector<double> distances_m;
    std::vector<std::uint32_t> tool_names; ///< Name of each face of the source.
    std::vector<std::uint32_t> object_names;
};
/// Truth for all poses; some milliseconds each.
[[nodiscard]] PairTruth find_pair_truth(const Scene& tool, const Scene& object,
                                        std::span<const Similarity> places);

/// Answers of one contestant to one question for every pose; fields not asked for are empty.
struct PairAnswers
{
    LeastTimes us;
    std::vector<bool> do_meet;
    std::vector<std::vector<test::FacePair>> meeting; ///< Pairs by places in the sources.
    std::vector<double> distances_m;
    std::uint64_t hash{0}; ///< Hash of the answers, so that they are used.
};
/// Asks for all poses in turn, `passes` times; the first one once before. Only the question is
/// timed. A failure only if passes differ.
[[nodiscard]] PairAnswers replay_pairs(PairQuery& query, std::span<const Similarity> places,
                                       PairQuestion question, std::uint32_t passes);

/// Errors: frames for `any`, pairs for `all_pairs` and `contacts`; the greatest error of a
/// distance, infinite for one that is not a number.
struct PairErrors
{
    std::uint64_t missed{0};
    std::uint64_t invented{0};
    double largest_m{0.0};
};
[[nodiscard]] PairErrors judge_pairs(const PairAnswers& answers, const PairTruth& truth,
                                     PairQuestion question);

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
