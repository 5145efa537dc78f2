// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/model_id.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/query/mesh_query.hpp"
#include "rt_core/query/other_surface.hpp"
#include "rt_core/query/unfinished_search.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/mesh_report.hpp"
#include "rt_core/records/prediction.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/scene/region_of_interest.hpp"
#include "rt_core/spm/error_code.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace tactus
{

class RegionPredictor;
struct Model;
struct PairFront;

/// Additional data of a pair whose tool is a mesh: each of the two surfaces is refined by its
/// distance from the other.
///
/// Most data exist for two places of the tool: the present one, and the one expected when a contact
/// could be refined. Haptic thread. 18 KiB.
class MeshPair
{
public:
    static constexpr std::size_t kPlaces = 2;

    /// Updates the pair for this frame. The boxes of both models' trees must be refitted. `tool` is
    /// the tool's pose in the object's frame; `frame` is the budget that pays for the searches.
    void place(const RegionOfInterest& region_of_interest, const MeshCore& core,
               const Model& tool_model, const Model& object_model, const Similarity& tool,
               const Budgets& budgets, WorkBudget& frame) noexcept TACTUS_NONBLOCKING;

    /// Moves the tool to a new pose in the same frame, for another query.
    void move(const Similarity& tool, const Budgets& budgets,
              WorkBudget& frame) noexcept TACTUS_NONBLOCKING;

    /// Adds the regions of both models where the two surfaces are near to the ranking.
    void rank(const RegionOfInterest& region_of_interest, ModelId tool_model, ModelId object_model,
              const RegionPredictor& predictor, Prediction prediction,
              RegionRanking& ranking) noexcept TACTUS_NONBLOCKING;

    /// True if the last query ended at a pair of faces that meet. The tool has no force until no
    /// faces meet, so only the surroundings of that pair must be exact.
    [[nodiscard]] bool is_meeting() const noexcept { return is_meeting_; }
    /// True if the tool is near a surface and approaches by no more than the reach of refinement:
    /// then its future place needs no questions.
    [[nodiscard]] static bool
    goes_along(const RegionOfInterest& region_of_interest) noexcept TACTUS_NONBLOCKING;
    /// Question to the object's model for one of the two places; ask_tool() is that to the tool's
    /// model.
    [[nodiscard]] RefineQuestion ask_object(std::size_t place,
                                            const RegionOfInterest& region_of_interest,
                                            RefineMemory& memory) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] RefineQuestion
    ask_tool(std::size_t place,
             const RegionOfInterest& region_of_interest) noexcept TACTUS_NONBLOCKING;

    /// Lower bound, in the object's frame, on the distance of any inexact face from the other
    /// surface, as this frame's refinement proves it; 0 if nothing is proven. `of_object` is the
    /// memory of the object's question about the first place.
    [[nodiscard]] double
    certified_m(const RefineMemory& of_object) const noexcept TACTUS_NONBLOCKING;

    /// Lends memory that queries keep from frame to frame; null takes it back. Returns the previous
    /// one.
    PairFront* exchange_front(PairFront* front) noexcept { return std::exchange(front_, front); }

    /// Distance within which contacts are searched: the reach, or a part of it beyond the radius
    /// after a truncated query.
    [[nodiscard]] double touch_m(double radius_m, double reach_m) const noexcept TACTUS_NONBLOCKING;
    /// Tolerance of the tool's model with the same error, in metres, as `tolerance` of the
    /// object's.
    [[nodiscard]] ErrorCode tool_tolerance(ErrorCode tolerance) const noexcept TACTUS_NONBLOCKING;
    /// Queries distance, meeting faces and contacts, in the object's frame. Contacts are within
    /// `contact_m`, none if negative. `enough` meeting pairs end the search. `ends` may be null;
    /// `certified_m` is the result of certified_m(). Faces of the object with errors up to
    /// `tolerance` count as the surface, and faces of the tool up to tool_tolerance().
    void query(const RegionOfInterest& region_of_interest, double certified_m, double contact_m,
               std::uint32_t enough, ErrorCode tolerance, ContactEnds* ends, DistanceAnswer& answer,
               ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

    /// Records a lower bound on the distance; above 0 proves that no faces meet.
    void note_lower(double lower_m) noexcept TACTUS_NONBLOCKING;
    /// Ends the certificates of the tool's faces, since the object has another surface.
    void forget_refinement() noexcept TACTUS_NONBLOCKING;
    /// Sets the report of a pair that is proven apart, without a query.
    void rest(ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

    /// Adds the work and faults of all searches since place().
    void add_work(WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const MeshReport& report() const noexcept { return report_; }

private:
    /// Divisor of a refining search's allowance at first. If a search is cut, the next frame's
    /// allowance is kSearchGrowth times as large, so that a search ends if nothing is to be split.
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
    /// Motion of the tool in this frame since refinement asked about the first place.
    double moved_on_m_{0.0};
    /// Placements of the tool's model in the object's frame, one for each place.
    std::array<MeshPlacement, kPlaces> placements_{};
    std::array<PlacedCore, kPlaces> cores_{};
    /// Motion of the tool since the last frame, in the object's frame.
    std::array<double, kPlaces> moved_m_{};
    /// Surface of the object, for refining the tool's model.
    std::array<OtherSurface, kPlaces> objects_{};
    /// Surface of the tool, for refining the object's model.
    std::array<OtherSurface, kPlaces> tools_{};
    OtherSurface covered_; ///< Surface of the object, for the cover.
    OtherSurface queried_; ///< Surface of the object, for the query.
    std::array<RefineMemory, kPlaces> tool_memories_{};
    /// Rest of a cut search in the object's model, for the first place.
    UnfinishedSearch of_object_;
    UnfinishedSearch of_tool_;
    Sphere own_sphere_; ///< Bounding sphere of the tool's model, in the model's frame.
    /// Spheres that held the tool's faces near the object when last computed.
    CoreCover cover_;
    double cover_moved_m_{0.0}; ///< Motion of the tool since cover_ was computed.
    std::uint32_t frames_until_cover_{0};
    MeshMemory memory_;
    bool is_meeting_{false};
    /// True if this frame's questions are about the meeting faces only.
    bool asks_about_meeting_{false};
    bool asks_otherwise_{false};    ///< True if asks_about_meeting_ differs from the last frame's.
    Vec3 meeting_m_{0.0, 0.0, 0.0}; ///< Meeting point of two faces, in the object's frame.
    /// Front lent to this pair; null while other pairs have higher priority.
    PairFront* front_{nullptr};
    MeshReport report_;
    /// Divisor of the allowance of refining searches, 1 .. kSearchParts.
    std::uint32_t search_parts_{kSearchParts};
    bool were_cut_short_{false}; ///< True if a refining search of this frame was cut.
    /// True if each search used at most 1 / kSearchGrowth of its allowance.
    bool were_far_from_cut_{true};
    /// Distance from the object within which cover_ holds the tool's faces.
    double cover_near_m_{0.0};
};

} // namespace tactus
