// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/model.hpp"
#include "rt_core/predict/region_predictor.hpp"
#include "rt_core/query/mesh_query.hpp"
#include "rt_core/records/mesh_report.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/scene/outlook.hpp"

#include <array>
#include <utility>

namespace tactus
{

/// What a pair of a tool that is a mesh and an object needs beyond other pairs: two surfaces, each
/// refined by how near the other is.
///
/// Everything is done for two places of the tool: where it is, and where it will be when a contact
/// can be refined. Haptic thread. 18 KiB.
class MeshPair
{
public:
    static constexpr std::size_t kPlaces = 2;

    /// Fits the pair to this frame: both models' boxes must be right, and `tool` is where the tool
    /// lies in the object's frame. What is looked at draws on the frame's work.
    void place(const Outlook& outlook, const MeshCore& core, const Model& tool_model,
               const Model& object_model, const Similarity& tool, const Budgets& budgets,
               WorkBudget& frame) noexcept TACTUS_NONBLOCKING;

    /// The tool has moved on in the same frame, to be queried there.
    void move(const Similarity& tool, const Budgets& budgets,
              WorkBudget& frame) noexcept TACTUS_NONBLOCKING;

    /// Adds what both models need where the surfaces are near.
    void rank(const Outlook& outlook, ModelId tool_model, ModelId object_model,
              const RegionPredictor& predictor, Prediction prediction,
              RegionRanking& ranking) noexcept TACTUS_NONBLOCKING;

    /// Whether the last query ended with a pair that meets. What is felt waits until nothing does,
    /// so only what is about that pair has to be exact.
    [[nodiscard]] bool is_meeting() const noexcept { return is_meeting_; }
    /// Whether the tool is at a surface and comes no farther than is refined beyond the reach
    /// there: where it will be needs no questions of its own.
    [[nodiscard]] static bool goes_along(const Outlook& outlook) noexcept TACTUS_NONBLOCKING;
    /// What a place asks of the object, and of the tool.
    [[nodiscard]] RefineQuestion ask_object(std::size_t place, const Outlook& outlook,
                                            RefineMemory& memory) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] RefineQuestion ask_tool(std::size_t place,
                                          const Outlook& outlook) noexcept TACTUS_NONBLOCKING;

    /// How far from the other surface this frame's refinement has proven all that is not exact to
    /// be, by what is known of the first place's questions: `of_object` is the object's. In the
    /// object's frame; 0 where nothing is.
    [[nodiscard]] double
    certified_m(const RefineMemory& of_object) const noexcept TACTUS_NONBLOCKING;

    /// Lends what queries keep from frame to frame, or null, and returns what was lent before.
    PairFront* exchange_front(PairFront* front) noexcept { return std::exchange(front_, front); }

    /// How far touches are looked for: the reach, or after a query that was cut a part of what the
    /// reach is more than the radius.
    [[nodiscard]] double touch_m(double radius_m, double reach_m) const noexcept TACTUS_NONBLOCKING;
    /// In the object's frame; contacts within `contact_m`, none when it is negative. `enough` pairs
    /// that meet end the search. `ends` may be null, and `certified_m` is as above.
    void query(const Outlook& outlook, double certified_m, double contact_m, std::uint32_t enough,
               ContactEnds* ends, DistanceAnswer& answer,
               ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

    /// The two are known to be at least so far apart, by the last query and those before it.
    void note_lower(double lower_m) noexcept TACTUS_NONBLOCKING;
    /// Instead of a query, while the pair is proven to be apart.
    void rest(ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

    /// What was looked at since place().
    void add_work(WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const MeshReport& report() const noexcept { return report_; }

private:
    /// A search to refine begins with this part of what it may look at; where that was too little,
    /// kSearchGrowth times as much is for the next frame, so that it comes to an end where nothing
    /// is to be split.
    static constexpr std::uint32_t kSearchParts = 32;
    static constexpr std::uint32_t kSearchGrowth = 4;

    void see_surfaces(const Budgets& budgets, WorkBudget& frame) noexcept;
    void fit_searches() noexcept;
    void note_use() noexcept;
    [[nodiscard]] RefineQuestion about_meeting(const Vec3& center_m, double radius_m, double scale,
                                               RefineMemory& memory) const noexcept;
    void find_cover(double near_m) noexcept;
    [[nodiscard]] static double refine_reach_m(const Outlook& outlook) noexcept;
    [[nodiscard]] double ahead_m(std::size_t place, const Outlook& outlook) const noexcept;
    [[nodiscard]] static RefineQuestion question(const Ball& ball, double reach_m, double moved_m,
                                                 double ahead_m, OtherSurface& surface,
                                                 RefineMemory& memory,
                                                 UnfinishedSearch* unfinished) noexcept;

    const Model* tool_model_{nullptr};
    const Model* object_model_{nullptr};
    double moved_on_m_{0.0}; ///< In this frame, after it was refined for the first place.
    std::array<MeshPlacement, kPlaces> placements_{}; ///< Of the tool's model in the object's.
    std::array<PlacedCore, kPlaces> cores_{};
    std::array<double, kPlaces> moved_m_{};       ///< Since the last frame, in the object's frame.
    std::array<OtherSurface, kPlaces> objects_{}; ///< As the tool's model sees it, to refine.
    std::array<OtherSurface, kPlaces> tools_{};   ///< As the object's model sees it, to refine.
    OtherSurface covered_;                        ///< The object for the cover,
    OtherSurface queried_;                        ///< and for the query.
    std::array<RefineMemory, kPlaces> tool_memories_{};
    UnfinishedSearch of_object_; ///< Of the first place, which is needed now.
    UnfinishedSearch of_tool_;
    Ball own_ball_;             ///< Round the tool's model, in its frame.
    CoreCover cover_;           ///< Of the tool's model near the object, as it was found last.
    double cover_moved_m_{0.0}; ///< The tool, since then.
    std::uint32_t frames_until_cover_{0};
    MeshMemory memory_;
    bool is_meeting_{false};
    bool asks_about_meeting_{false}; ///< In this frame, instead of all that is near.
    bool asks_otherwise_{false};     ///< Than in the last frame.
    Vec3 meeting_m_{0.0, 0.0, 0.0};  ///< Where, in the object's frame.
    PairFront* front_{nullptr};      ///< Null while others are more urgent.
    MeshReport report_;
    /// Searches to refine have one of so many parts of what they may look at.
    std::uint32_t search_parts_{kSearchParts};
    bool were_cut_short_{false};   ///< One of them, in this frame.
    bool were_far_from_cut_{true}; ///< All of them.
    double cover_near_m_{0.0};     ///< So far the cover reaches.
};

} // namespace tactus
