// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <cstdint>

/// Capacities, loop bounds and tolerances of rt_core. Each comment names the bounded thing, its
/// unit, the reason for the value, its cost, and the consequence of reaching it. Nothing is dropped
/// silently: input is refused, the answer reports less, or a FrameFault names the limit.
///
/// Constants that affect only the speed or the quality of one algorithm stand at the top of its
/// source, rounding errors beside their arithmetic, and layout sizes beside the layout. A test
/// names each constant below (guard.text); the guard does not show that the test reaches it.
// Any thread: constants.
namespace tactus
{

// --- The mesh format -----------------------------------------------------------------------------

/// Largest number of faces in a record's star, including those that its split adds; 9 B each in
/// every record. The encoder makes no larger star, which costs no quality (design measurements). A
/// chunk's code can't describe one.
inline constexpr std::uint32_t kMaxStarFaces = 8;
/// Largest number of fan faces in a star: all faces but A and B (VsplitRecord). A star without A or
/// B has no longer fan. A chunk with a longer fan is refused.
inline constexpr std::uint32_t kMaxFanFaces = kMaxStarFaces - 2;

/// Largest number of records of a model: FaceState stores the record's id in 29 bits, and all ones
/// mean the base state. A header beyond this limit, or another of this section, is refused unless
/// stated otherwise.
inline constexpr std::uint32_t kMaxRecords = (1U << 29U) - 2;
/// Largest base mesh, in faces. Base faces are always resident: about 150 B each.
inline constexpr std::uint32_t kMaxBaseFaces = 16'384;
/// Largest base mesh, in vertices: three per face if no triangles share one.
inline constexpr std::uint32_t kMaxBaseVertices = 3 * kMaxBaseFaces;
/// Largest dependency depth of a record; 20 to 60 on real meshes. It sizes the stack on which
/// refinement splits a record after its dependencies, 4 B per entry.
inline constexpr std::uint32_t kMaxDepth = 1'024;
/// Range of a model's coordinate width, in bits. A coordinate is an integer of that width times the
/// quantum, so exact in a float.
inline constexpr std::uint32_t kMinPositionBits = 16;
inline constexpr std::uint32_t kMaxPositionBits = 24;
static_assert(kMinPositionBits <= kMaxPositionBits);
static_assert(kMaxPositionBits <= 24, "a float's mantissa holds a coordinate exactly");

/// Largest coordinate of a model in its source's frame, either sign; a header with a larger one is
/// refused. Map coordinates are smaller, and no tool could reach farther (kGoalRange_m).
inline constexpr double kModelReachMax_m = 1e7;
/// Largest coordinate of a hull's vertices, either sign. A hull beyond it is refused: differences
/// would overflow.
inline constexpr double kCoordinateRange = 1e300;
/// Range of log2 of the quantum in metres, wider than any use: a micrometre-sized model at 24 bits
/// has 2^-44 m, one of 10^6 m at 16 bits 2^4 m.
inline constexpr std::int32_t kMinQuantumLog2 = -60;
inline constexpr std::int32_t kMaxQuantumLog2 = 20;
/// Largest number of cells in a model's regular partition; one bit each in the header, 32 KiB in
/// all. The encoder refuses more, too.
inline constexpr std::uint32_t kMaxRegions = 1U << 18U;
/// Largest size of a coded chunk in bytes; about 550 are usual. A buffer of this size holds any
/// chunk. An index page that states a larger chunk is refused.
inline constexpr std::size_t kMaxCodedChunkBytes = 8'448;

// --- The scene -----------------------------------------------------------------------------------

/// Largest number of tools; 3 KiB each. Frame::start refuses more.
inline constexpr std::uint32_t kMaxTools = 16;
/// Largest capacity of a scene in objects; about 250 B each. Frame::start reserves the capacity
/// that its caller sets, and refuses a larger one.
inline constexpr std::uint32_t kMaxObjects = 4'096;
/// Largest number of models that share the pools; 12 KiB each besides header and base mesh. A
/// slot's owner is stored in one byte.
inline constexpr std::uint32_t kMaxModels = 256;
/// Largest number of tracked pairs of a tool and a near object; 5.3 KiB each, 3 KiB more with
/// contacts and 10 KiB more if the tool is a mesh. The nearest pairs are tracked. A tool goes no
/// farther than its clearance from untracked objects (FrameFault::scene_over_capacity).
inline constexpr std::uint32_t kMaxPairs = 64;
/// Largest number of objects on a tool's list of near ones; 4 B each. The nearest are listed. A
/// tool goes no farther than its clearance from unlisted objects (FrameFault::scene_over_capacity).
inline constexpr std::uint32_t kMaxNear = 32;
/// Largest number of walks over all objects of a scene in one frame. A walk serves one tool and
/// takes 11 us for 4,096 objects, or 43 us if all are near. A tool that waits for its walk goes no
/// farther than its known clearance.
inline constexpr std::uint32_t kBroadWalks = 4;
/// Largest number of scene changes that a frame takes; 208 B each. Further ones of the same frame
/// are refused (ChangeRefusal::too_many).
inline constexpr std::uint32_t kMaxSceneChanges = 64;
/// Largest number of faces that one edit removes, and that it adds; 48 B of both in a queue. A
/// frame makes an edit whole, before its stages, with at most 100,000 instructions of its budget of
/// work. A larger edit is refused (EditRefusal::too_large).
inline constexpr std::uint32_t kMaxEditFaces = 48;
/// Largest number of edits that a frame takes. Further ones of the same frame are refused
/// (EditRefusal::too_many).
inline constexpr std::uint32_t kMaxEditsPerFrame = 2;
/// Largest room of a model for faces that edits add; about 150 B each. Frame::start refuses more.
inline constexpr std::uint32_t kMaxAddedFaces = 1U << 18U;
/// Largest number of boxes round the removed faces of a model; 24 B each. With more, the two boxes
/// whose union is smallest become one: more coarse faces then bound the distance from below only.
inline constexpr std::uint32_t kMaxRemovedBoxes = 32;
/// Largest number of active faces of all models together: a face's slot number takes 24 bits beside
/// its owner's byte. 108 B each with their part of the tree. Frame::start refuses larger pools.
inline constexpr std::uint32_t kMaxPoolFaces = (1U << 24) - 1;

/// Largest number of spheres that cover a tool's core; refinement serves each one, at 370 B per
/// pair. Around a capsule as long as sixteen radii, refinement extends at most 2.5 radii from the
/// axis. A longer core or a mesh has larger spheres, and more is refined than needed.
inline constexpr std::uint32_t kMaxCoverSpheres = 8;

/// Memory of a frame for the pairs' exact triangles, as a multiple of kMaxLocalTriangles; 48 KiB
/// each. The highest-priority pairs take theirs first.
inline constexpr std::uint32_t kLocalSurfaces = 4;
/// Largest number of exact triangles that one pair passes to the force stage; 48 B each. Usual are
/// 76 for a tool of 1 % of the diagonal at 1.1 M faces, and 750 for a fast sphere. If more are in
/// reach, the nearest are kept, at least seven eighths of this number. The certified radius then
/// ends at the nearest dropped one (FrameFault::surface_truncated).
inline constexpr std::uint32_t kMaxLocalTriangles = 1'024;

/// Largest number of contacts of one pair; 96 B each. With more, the nearest are kept and the
/// report is marked incomplete. A tool with a torque then feels only these
/// (FrameFault::tool_over_capacity), but can't cross the others: its step ends at the proven
/// distance.
inline constexpr std::uint32_t kMaxContacts = 32;
/// Largest number of pairs of meeting faces in a mesh tool's report on one object; 8 B each. With
/// more, the report is marked truncated.
inline constexpr std::uint32_t kMaxMeetingFaces = 1'024;
/// Number of faces meeting a tool after which its query stops; for a mesh tool without a list of
/// pairs, the number of meeting pairs. A tool is then so deep in the object that contacts give no
/// exit direction. A tool of 980 faces half in a bunny of 69,000 met 161 pairs.
inline constexpr std::uint32_t kEnoughMeetingFaces = 256;
static_assert(kEnoughMeetingFaces > kMaxContacts && kEnoughMeetingFaces <= kMaxMeetingFaces);

// --- The frame -----------------------------------------------------------------------------------

/// Largest budgets of splits and merges (records/frame_input.hpp); they size scratch memory. A
/// larger budget is cut to this. Faces that stay coarse are reported as with any spent budget;
/// merges not done only cost memory.
inline constexpr std::uint32_t kMaxSplitsPerFrame = 256;
inline constexpr std::uint32_t kMaxMergesPerFrame = 256;
/// Largest number of coarse faces that wait to be split in one frame; 16 B each. Further faces wait
/// for the next frame and end the certificate (FrameFault::refine_heap_full).
inline constexpr std::uint32_t kRefineHeap = 1'024;
/// Largest number of blocks with coarse faces that one search near a mesh tool's surface keeps; 72
/// B each. Faces of further blocks wait for the next frame and end the certificate.
inline constexpr std::uint32_t kMaxNearBlocks = 64;
/// Largest number of records, of all models, that are held: split for an incomplete closure and not
/// merged meanwhile. 8 B each. Further records may be merged and split again
/// (FrameFault::held_records_full).
inline constexpr std::uint32_t kMaxHeldRecords = 1'024;
static_assert(kMaxSplitsPerFrame <= kMaxHeldRecords, "one frame's splits can all be held");
/// Levels of nodes in the AB-Tree, one for each octal digit of its 64-bit paths. No two faces have
/// the same path, so a tree can't be deeper.
inline constexpr std::uint32_t kTreeLevels = 22;
/// Entries of a traversal's stack: 7 siblings on each level and the 8 children of the last node. No
/// tree of kTreeLevels needs more; overflow is a bug (asserted).
inline constexpr std::uint32_t kTreeStack = kTreeLevels * 7 + 8;
/// Factor on Budgets::nodes and Budgets::triangles for all refinement of a frame, and as much for
/// all its queries. The highest-priority pairs come first; later traversals are cut short, with the
/// bounds proven so far (FrameFault::node_budget_spent). A slide over 60,000 faces visits about 25
/// nodes a frame.
inline constexpr std::uint32_t kFrameWalks = 8;
/// Factor on Budgets::nodes and Budgets::triangles for the query of one pair of a mesh tool, which
/// may have thousands of faces near the object. Beyond it the search is cut short
/// (FrameFault::node_budget_spent).
inline constexpr std::uint32_t kMeshBudgetFactor = 16;
/// Factor on Budgets::nodes and Budgets::triangles for refinement of one pair of a mesh tool, for
/// either model, now and ahead. Faces that were not reached are checked in the next frame and stay
/// coarse until then (FrameFault::node_budget_spent).
inline constexpr std::uint32_t kMeshRefineFactor = 4;
static_assert(kMeshRefineFactor < kMeshBudgetFactor, "what is coarse still can be asked about");
/// Largest number of spheres that the predictor ranks; 56 B each, five for each cover sphere of a
/// near pair. Enough for a spherical tool in each pair, or four rigid tools of eight spheres.
/// Predicted spheres of later pairs are dropped first, so their chunks come late; then present ones
/// (FrameFault::ranking_full).
inline constexpr std::uint32_t kMaxRankedRegions = 6 * kMaxPairs;
/// Least number of slots for index pages of all models, unless the models have fewer; 772 B each.
/// Large pools have more slots. Evicted index pages are requested again when needed.
inline constexpr std::uint32_t kLeastResidentIndexPages = 192;
/// Number of requests under way from which on the load of a whole model sends no more. A tool's
/// requests must not wait behind more of these, nor be dropped from the transport thread's list
/// (SlotQueues::kOpenRequests).
inline constexpr std::uint32_t kMaxFillingRequests = 128;
/// Rounding error of converting a point into a model's frame and back, as a share of its distance
/// from the object's origin plus its own coordinates. Each conversion rounds about seven times by
/// 1.1e-16, and R^T R of a rotation may be 2e-15 from the identity. Bounds are widened by it.
inline constexpr double kPoseRounding = 4e-15;
/// Rounding error of a model's origin when its pose is computed from its source mesh's pose, as a
/// share of the distance between both origins. Each coordinate rounds four times by 1.1e-16.
inline constexpr double kOriginRounding = 1e-15;
/// Distance from the model's origin, in quanta, from which the kernels are not used: squares would
/// leave single precision, and the model's bounding box answers instead. A model has at most 2^24
/// quanta per side.
inline constexpr double kFarQuanta = 0x1p36;
/// Frames after which an unanswered request expires and may be repeated, at 1 kHz.
inline constexpr std::uint32_t kRequestTimeoutFrames = 250;
/// Time after which a request expires, for loops of any rate: longer than a bad link takes.
inline constexpr std::int64_t kRequestTimeout_ns = 250'000'000;

/// Largest numbers of arrivals (even if Budgets::pages is larger) and of link updates that a frame
/// takes from the queues; 32 B each, also in a recording. Further ones wait for the next frame.
inline constexpr std::uint32_t kMaxArrivalsPerFrame = 64;
inline constexpr std::uint32_t kMaxLinkUpdatesPerFrame = 64;

/// Largest number of base faces that enter their trees in one frame, for all added models: 10 us.
inline constexpr std::uint32_t kEnteringFacesPerFrame = 128;
/// Largest numbers, per frame, of faces that removed models take out of their trees, and of slots
/// checked for a removed model's pages.
inline constexpr std::uint32_t kLeavingFacesPerFrame = 512;
inline constexpr std::uint32_t kLeavingSlotsPerFrame = 256;

// --- Force ---------------------------------------------------------------------------------------

/// Largest number of steps of the proxy in one frame; a step ends where another triangle blocks it.
/// 2 to 6 are usual. After the last one the proxy is `under_way` and continues in the next frame.
inline constexpr std::uint32_t kProxySteps = 24;
/// Length of a motion, as a share of the tool's radius, below which the proxy is at rest: 0.1 uN at
/// 500 N/m and 2 mm.
inline constexpr double kLeastStep = 1e-7;
/// Length of a motion against friction, as a share of the tool's radius, below which the proxy is
/// at rest; also the accepted error of a slip. 0.1 mN at 500 N/m and 2 mm.
inline constexpr double kSlipShare = 1e-4;
/// Distance, as a share of the tool's radius, within which triangles touch the tool: they press,
/// cause friction and may hold it. Larger than kLeastStep; otherwise triangles just ahead would
/// shorten a step to nothing.
inline constexpr double kTouchShare = 1e-4;
/// Largest number of batches of eight triangles among which the proxy moves; 226 B each on the
/// stack. Of more batches in reach the farthest are left out. The proxy then goes no farther than
/// the nearest of these and is `under_way`.
inline constexpr std::uint32_t kMaxNearBatches = 144;
/// Largest number of times that a proxy step is solved again with a plane of the triangle that it
/// would enter; 2 or 3 are usual. A step that still enters one is shortened, and the next step
/// begins there. Shortened steps stay above zero: touching triangles have planes from the start,
/// and others are at least kTouchShare away. Also bounds the faces checked along the path to a
/// first contact with friction.
inline constexpr std::uint32_t kStepRounds = 16;
/// Depth by which a surface may lie within the tool's radius and count as touching, as a share of
/// that radius. A deeper surface counts as entered.
inline constexpr double kContactTolerance = 1e-6;
/// Largest number of planes that limit one motion; 5 us with all of them in six dimensions. Beyond
/// it a rigid tool drops the planes that limit it least, and a sphere's force ignores later planes
/// (FrameFault::tool_over_capacity).
inline constexpr std::uint32_t kMaxHalfSpaces = 64;
/// Largest number of faces checked in double precision for contacts where the proxy stops; 300
/// instructions each. As many are checked to find the free part of a step once Budgets::planes are
/// used up. A sphere feels only checked faces (FrameFault::tool_over_capacity). Beyond them a step
/// keeps the length that single precision proves.
inline constexpr std::uint32_t kMaxTouchLooks = 4 * kMaxHalfSpaces;
/// Largest number of iterations of a search for the nearest allowed motion; each adds or removes a
/// plane. The worst of a million hard cases took 72. After half of them kSqueezeTolerance replaces
/// kPlaneTolerance; after all of them the tool is `over_constrained`.
inline constexpr std::uint32_t kConstraintRounds = 128;
/// Distance by which a motion may exceed a plane, relative to the lengths of the problem.
inline constexpr double kPlaneTolerance = 1e-12;
/// Sine of the angle of two planes below which they count as parallel: two such planes that face
/// each other bound a gap, not a wedge with an edge far away.
inline constexpr double kParallelPlanes = 1e-7;
/// Amount by which a gap between planes must be too narrow for the tool to be over-constrained, as
/// a share of the lengths of the problem.
inline constexpr double kSqueezeTolerance = 1e-6;
/// Largest number of faces that a sphere's force shading averages; 300 instructions each where the
/// proxy stops. With more within the width, the width is reduced to the distance of the nearest
/// further face.
inline constexpr std::uint32_t kMaxShadedFaces = 64;
/// Range of the width over which a tool's force shading averages.
inline constexpr double kShadingWidthMin_m = 1e-4;
inline constexpr double kShadingWidthMax_m = 0.1;
/// Radius, in quanta, of the sphere that represents a point tool without a radius.
inline constexpr double kPointSkin = 0.25;
/// Largest number of past contact points kept while a rigid tool rests; 88 B each. Six planes
/// suffice to hold a tool. Beyond it the oldest is dropped (FrameFault::tool_over_capacity).
inline constexpr std::uint32_t kMaxHolds = 16;
/// Distance that a rigid tool without a radius keeps from surfaces so that it can slide, as a share
/// of its core's radius.
inline constexpr double kLeastSkin = 0.002;
/// Time in which ForceFader fades a force to zero, in seconds.
inline constexpr double kFadeTime_s = 0.05;
/// Rates at which the force grows after a proxy waited for data: this share of the device's largest
/// force or torque per second, but at most the newtons below. At 1 kHz 0.8 % and 0.04 N a frame.
inline constexpr double kCatchUpShare_per_s = 8.0;
inline constexpr double kCatchUp_n_per_s = 40.0;
/// Time in which a faded force returns, in seconds: slower than it faded, so that an intermittent
/// cause leaves little force.
inline constexpr double kRiseTime_s = 0.1;
/// Device speed, as a share of the speed limit, below which the force returns after an excess.
inline constexpr double kCalmSpeedShare = 0.5;
/// Rotation speed of a device, in rad/s, above which it gets no force and no torque, and its motion
/// counts for no energy. A wrist reaches 30.
inline constexpr double kRotationMax_rad_per_s = 60.0;
/// Largest damping while a force fades or returns, as a share of the device's largest force.
inline constexpr double kDampingForceShare = 0.25;
/// Largest value of `--force-tolerance`, in newtons: the change of a force by coarse faces that
/// count as the surface while the pools have room for finer ones. A tenth of what a user feels at a
/// wall.
inline constexpr double kForceToleranceMax_n = 0.1;
/// Default of `--force-tolerance`, in newtons: imperceptible.
inline constexpr double kForceToleranceUsual_n = 0.001;
/// Default and least value of `--slew`: change of a force beyond the effect of device and object
/// motion, as a share of the device's largest force per millisecond. The default is 0.08 N for 8 N.
/// A strike then rises in 100 ms, about as fast as a hand yields.
inline constexpr double kSlewShare_per_ms = 0.01;
inline constexpr double kSlewShareMin_per_ms = 1e-4;
/// Time, in seconds, for which the slew limit must act before ForceOff::growth is reported.
inline constexpr double kChangeTold_s = 0.02;
/// Share of a device's own damping that may be added by computation. A sampled damper b on a device
/// with damping B stays passive while b + k T / 2 < B (Colgate and Schenkel 1997). Here k is the
/// wall's stiffness and T the period. Half leaves the other half to the wall.
inline constexpr double kDampingShare = 0.5;

// --- Stability (docs/stability.md) ---------------------------------------------------------------

/// Stiffness allowed for a wall, as a share of the predicted maximum stable stiffness. Covers
/// fractions of a period in the delay (8 %) and a damping of the device known to 10 %.
inline constexpr double kStiffnessMargin = 0.9;
/// Largest number of positions from which a velocity is estimated; 32 B each. 16 at 1 kHz resolve
/// 1/16 of a quantum per period. Older positions are dropped.
inline constexpr std::uint32_t kVelocitySamples = 16;
/// Number of sent forces kept until the device applies them; 32 B each, enough for a delay of nine
/// periods. With a longer delay the energy is computed from the oldest kept force, which is newer
/// than the applied one (ForceAction::blind).
inline constexpr std::uint32_t kForcesUnderWay = 10;
/// Speed above which a device has jumped: its energy is not observed (ForceAction::blind). A hand
/// reaches 10 m/s at most.
inline constexpr double kDeviceSpeedMax_m_per_s = 10.0;
/// Damping force, in newtons, up to which no damping is added: the rounding of a tool at rest.
inline constexpr double kLeastDamping_n = 1e-3;

// --- Convex tools --------------------------------------------------------------------------------

/// Vertices of a convex hull. Each answer needs a few support points, each a check of all vertices,
/// 2 ns per vertex; a rounder tool than 64 vertices allow is given by a support function. A hull
/// with more is refused.
inline constexpr std::uint32_t kMaxHullVertices = 64;
/// Largest number of support points for one distance of a convex body from a triangle. Hulls need 4
/// as a rule and 15 at most in two million cases. Curved bodies that nearly touch reach this limit
/// and get valid but wider bounds.
inline constexpr std::uint32_t kGjkIterations = 64;
/// Difference of a convex body's distance bounds, as a share of the distance, at which the search
/// ends.
inline constexpr double kGjkRelativeGap = 1e-12;
/// Largest number of faces averaged for a vertex normal; 16 B each on the stack. With more, the
/// normal is zero, which means unknown.
inline constexpr std::uint32_t kMaxIncidentFaces = 64;

// --- Poses of objects and of devices -------------------------------------------------------------

/// Ranges of the translation's coordinates (either sign) and of the scale in `--place`, a server's
/// poses and a device frame.
inline constexpr double kPoseReachMax_m = 1e4;
inline constexpr double kPoseScaleMin = 1e-3;
inline constexpr double kPoseScaleMax = 1e3;
/// Largest friction coefficient and damping of a material; larger values are unphysical and could
/// overflow results.
inline constexpr double kFrictionMax = 1e3;
inline constexpr double kDampingMax_n_s_per_m = 1e9;
/// Range of the length of a texture's bumps, and their largest height as a share of it. Steeper
/// bumps would make a wall more than 1.2 times as stiff as specified, and could pull
/// (docs/coupling.md). Other materials are refused (ChangeRefusal::bad_material).
inline constexpr double kTextureLengthMin_m = 1e-4;
inline constexpr double kTextureLengthMax_m = 1.0;
inline constexpr double kTextureSteepest = 0x1p-5;
/// Time in which a material change takes effect during contact: fifty steps at 1 kHz, each a
/// fiftieth of the change.
inline constexpr double kMaterialBlend_s = 0.05;
/// Largest deviation of R^T R from the identity, per entry, with which a tool's or device frame's
/// rotation is accepted and made orthonormal. Beyond it a sample is FrameFault::tool_invalid, and a
/// device frame is refused.
inline constexpr double kRotationTolerance = 1e-6;
/// Largest accepted deviation of a server's quaternion from length 1; the length is divided out.
/// Wider than kRotationTolerance, as senders may compute in float.
inline constexpr double kPoseUnitTolerance = 1e-3;

// --- Samples of the device -----------------------------------------------------------------------

/// Largest coordinate of device positions and goals, either sign; beyond it a sample is
/// FrameFault::tool_invalid. Wider than kPoseReachMax_m, as a device frame scales and moves the
/// device's values.
inline constexpr double kGoalRange_m = 1e6;
/// Time, in seconds, for which the last sample replaces missing or unusable ones: 20 periods at 1
/// kHz. Then the force fades within kFadeTime_s (FrameFault::tool_stuck if the device's time does
/// not advance).
inline constexpr double kSampleHold_s = 0.02;
/// Speed above which a goal has jumped (FrameFault::tool_jumped), as a multiple of
/// ToolSpec::speed_max_m_per_s, or of 1 m/s if that is less. A hand reaches 10 m/s at most.
inline constexpr double kJumpSpeeds = 100.0;
/// Rotation speed of a goal, in rad/s, above which it has jumped: at 1 kHz 57 degrees in one frame.
inline constexpr double kJumpRotation_rad_per_s = 1'000.0;

// --- Names ---------------------------------------------------------------------------------------

/// Largest length of a model's or tool's name in bytes of UTF-8. A longer name is refused.
inline constexpr std::size_t kMaxNameBytes = 63;

} // namespace tactus
