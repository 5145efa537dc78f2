// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/model.hpp"
#include "rt_core/predict/region_predictor.hpp"
#include "rt_core/query/mesh_query.hpp"
#include "rt_core/records/mesh_report.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/scene/region_of_interest.hpp"

#include <array>
#include <utility>

namespace tactus
{

/// Additional data of a pair whose tool is a mesh: two surfaces, each refined by its distance from
/// the other.
///
/// Everything exists for two places of the tool: its present one, and the one where it will be when
/// a contact can be refined. Haptic thread. 18 KiB.
class MeshPair
{
public:
    static constexpr std::size_t kPlaces = 2;

    /// Updates the pair for this frame: both models' boxes must be right, and `tool` is the tool's
    /// pose in the object's frame. Searches draw on the frame's work.
    void place(const RegionOfInterest& region_of_interest, const MeshCore& core,
               const Model& tool_model, const Model& object_model, const Similarity& tool,
               const Budgets& budgets, WorkBudget& frame) noexcept TACTUS_NONBLOCKING;

    /// Moves the tool on in the same frame, for another query.
    void move(const Similarity& tool, const Budgets& budgets,
              WorkBudget& frame) noexcept TACTUS_NONBLOCKING;

    /// Adds the regions of both models where the surfaces are near.
    void rank(const RegionOfInterest& region_of_interest, ModelId tool_model, ModelId object_model,
              const RegionPredictor& predictor, Prediction prediction,
              RegionRanking& ranking) noexcept TACTUS_NONBLOCKING;

    /// True if the last query ended with a pair of faces that meet. The force waits until no faces
    /// meet, so only the surroundings of that pair must be exact.
    [[nodiscard]] bool is_meeting() const noexcept { return is_meeting_; }
    /// True if the tool is at a surface and approaches by no more than is refined beyond the reach
    /// there: its future place needs no questions.
    [[nodiscard]] static bool
    goes_along(const RegionOfInterest& region_of_interest) noexcept TACTUS_NONBLOCKING;
    /// Question to the object's model for one of the places; below, to the tool's.
    [[nodiscard]] RefineQuestion ask_object(std::size_t place,
                                            const RegionOfInterest& region_of_interest,
                                            RefineMemory& memory) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] RefineQuestion
    ask_tool(std::size_t place,
             const RegionOfInterest& region_of_interest) noexcept TACTUS_NONBLOCKING;

    /// Distance from the other surface that this frame's refinement proves for all inexact faces,
    /// from the first place's questions; `of_object` is the object's memory. In the object's frame;
    /// 0 if nothing is proven.
    [[nodiscard]] double
    certified_m(const RefineMemory& of_object) const noexcept TACTUS_NONBLOCKING;

    /// Lends memory that queries keep from frame to frame, or null, and returns the previous one.
    PairFront* exchange_front(PairFront* front) noexcept { return std::exchange(front_, front); }

    /// Distance up to which contacts are searched: the reach, or after a truncated query the radius
    /// and a part of the reach beyond it.
    [[nodiscard]] double touch_m(double radius_m, double reach_m) const noexcept TACTUS_NONBLOCKING;
    /// Queries in the object's frame; contacts within `contact_m`, none if negative. `enough`
    /// meeting pairs end the search. `ends` may be null, and `certified_m` is as above.
    void query(const RegionOfInterest& region_of_interest, double certified_m, double contact_m,
               std::uint32_t enough, ContactEnds* ends, DistanceAnswer& answer,
               ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

    /// Records a lower bound on the distance from the last query and those before it.
    void note_lower(double lower_m) noexcept TACTUS_NONBLOCKING;
    /// Replaces a query while the pair is proven apart.
    void rest(ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

    /// Adds the work of all searches since place().
    void add_work(WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const MeshReport& report() const noexcept { return report_; }

private:
    /// Number of parts of its allowance of which a refining search first uses one. If that was too
    /// little, the next frame allows kSearchGrowth times as much, so that the search ends if
    /// nothing is to be split.
    static constexpr std::uint32_t kSearchParts = 32;
    static constexpr std::uint32_t kSearchGrowth = 4;

    void see_surfaces(const Budgets& budgets, WorkBudget& frame) noexcept;
    void fit_searches() noexcept;
    void note_use() noexcept;
    [[nodiscard]] RefineQuestion about_meeting(const Vec3& center_m, double radius_m, double scale,
                                               RefineMemory& memory) const noexcept;
    void find_cover(double near_m) noexcept;
    [[nodiscard]] static double refine_reach_m(const RegionOfInterest& region_of_interest) noexcept;
    [[nodiscard]] double ahead_m(std::size_t place,
                                 const RegionOfInterest& region_of_interest) const noexcept;
    [[nodiscard]] static RefineQuestion question(const Sphere& sphere, double reach_m,
                                                 double moved_m, double ahead_m,
                                                 OtherSurface& surface, RefineMemory& memory,
                                                 UnfinishedSearch* unfinished) noexcept;

    const Model* tool_model_{nullptr};
    const Model* object_model_{nullptr};
    /// Motion in this frame since the first place was refined.
    double moved_on_m_{0.0};
    /// Poses of the tool's model in the object's frame.
    std::array<MeshPlacement, kPlaces> placements_{};
    std::array<PlacedCore, kPlaces> cores_{};
    /// Motion since the last frame, in the object's frame.
    std::array<double, kPlaces> moved_m_{};
    /// Object, for refining the tool's model.
    std::array<OtherSurface, kPlaces> objects_{};
    /// Tool, for refining the object's model.
    std::array<OtherSurface, kPlaces> tools_{};
    OtherSurface covered_; ///< Object, for the cover.
    OtherSurface queried_; ///< Object, for the query.
    std::array<RefineMemory, kPlaces> tool_memories_{};
    UnfinishedSearch of_object_; ///< Search for the first place, which is needed now.
    UnfinishedSearch of_tool_;
    Sphere own_sphere_; ///< Sphere round the tool's model, in its frame.
    /// Last cover of the tool's model near the object.
    CoreCover cover_;
    double cover_moved_m_{0.0}; ///< Motion of the tool since then.
    std::uint32_t frames_until_cover_{0};
    MeshMemory memory_;
    bool is_meeting_{false};
    /// Questions of this frame are about the meeting faces only.
    bool asks_about_meeting_{false};
    bool asks_otherwise_{false};    ///< Differs from the last frame.
    Vec3 meeting_m_{0.0, 0.0, 0.0}; ///< Meeting point in the object's frame.
    PairFront* front_{nullptr};     ///< Null while other pairs have higher priority.
    MeshReport report_;
    /// Divisor of the allowance of refining searches.
    std::uint32_t search_parts_{kSearchParts};
    bool were_cut_short_{false};   ///< A search of this frame was truncated.
    bool were_far_from_cut_{true}; ///< All searches used little of their allowance.
    double cover_near_m_{0.0};     ///< Distance that the cover includes.
};

} // namespace tactus
