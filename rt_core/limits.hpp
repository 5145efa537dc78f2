// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <cstdint>

/// Every capacity and tolerance of rt_core: what it bounds, its unit, why this value, what it
/// costs.
namespace tactus
{

// --- The mesh format -----------------------------------------------------------------------------

/// Faces in one record's star, the appearing ones included. Costs 9 B a face in every record;
/// a cap of 8 costs no quality (design measurements), so larger stars are never collapsed.
inline constexpr std::uint32_t kMaxStarFaces = 8;
/// Fan faces of a star: all but A and B (a border star misses one of those, its fan is not longer).
inline constexpr std::uint32_t kMaxFanFaces = kMaxStarFaces - 2;

/// Largest record count: FaceState keeps the record in 29 bits, all ones meaning the base state.
inline constexpr std::uint32_t kMaxRecords = (1U << 29U) - 2;
/// Largest base mesh the controller accepts, in faces. Base faces are resident: about 150 B each.
inline constexpr std::uint32_t kMaxBaseFaces = 16'384;
/// Base vertices; a soup of single triangles has three a face.
inline constexpr std::uint32_t kMaxBaseVertices = 3 * kMaxBaseFaces;
/// Dependency depth of a record (number of rounds of the encoder; 20 to 60 on real meshes).
/// It bounds the closure stack: depth x fan.
inline constexpr std::uint32_t kMaxDepth = 1'024;
/// Coordinates are integers of at most this many bits times the quantum, so exact in a float.
inline constexpr std::uint32_t kMinPositionBits = 16;
inline constexpr std::uint32_t kMaxPositionBits = 24;

/// The quantum is 2^-60 .. 2^20 m: from a micrometre-sized model at 24 bits to 10^6 m at 16.
inline constexpr std::int32_t kMinQuantumLog2 = -60;
inline constexpr std::int32_t kMaxQuantumLog2 = 20;
/// Cells of the regular partition: one bit each in the header, 32 KiB at most.
inline constexpr std::uint32_t kMaxRegions = 1U << 18U;
/// Chunks of one model, by kMaxRecords; bounds every chunk count that is read.
inline constexpr std::uint32_t kMaxChunks = (kMaxRecords + 63) / 64;
/// One coded chunk; about 550 B are usual. A reader may lend a buffer of this size and need no
/// other.
inline constexpr std::size_t kMaxCodedChunkBytes = 8'448;

// --- The scene -----------------------------------------------------------------------------------

/// Tools, objects and models of one frame. A pair of tool and object costs about 52 KiB, most of it
/// its local surface.
inline constexpr std::uint32_t kMaxTools = 4;
inline constexpr std::uint32_t kMaxObjects = 8;
inline constexpr std::uint32_t kMaxModels = 8;
inline constexpr std::uint32_t kMaxPairs = kMaxTools * kMaxObjects;

/// Balls that a tool's core is covered with, each a question to the refinement: around a capsule
/// as long as sixteen radii no farther than 2.5 radii from its axis is refined. 100 B each for a
/// pair.
inline constexpr std::uint32_t kMaxCoverBalls = 8;

/// Exact triangles handed to the force stage for one pair; 76 are usual at 1.1 M faces and a tool
/// of 1 % of the diagonal, 750 for a ball of eight edges that moves four edges a frame. With more,
/// the certified radius shrinks to those kept. 48 B each.
inline constexpr std::uint32_t kMaxLocalTriangles = 1'024;

/// Contacts told of one pair: the nearest ones. 128 B each.
inline constexpr std::uint32_t kMaxContacts = 32;
/// Pairs of faces that meet and are kept, of a tool that is a mesh and an object.
inline constexpr std::uint32_t kMaxMeetingFaces = 1'024;

// --- The frame -----------------------------------------------------------------------------------

/// Largest budgets that a caller may give (records/budgets.hpp); scratch memory follows them.
inline constexpr std::uint32_t kMaxSplitsPerFrame = 256;
inline constexpr std::uint32_t kMaxMergesPerFrame = 256;
/// Faces that wait to be split in one frame; 16 B each. Faces beyond it wait for the next frame.
inline constexpr std::uint32_t kRefineHeap = 1'024;
/// Records split for a closure that is not complete yet, kept from being merged; 4 B each.
inline constexpr std::uint32_t kMaxHeldRecords = 1'024;
/// A traversal's stack: 22 levels of 7 siblings and the 8 of the last node.
inline constexpr std::uint32_t kTreeStack = 22 * 7 + 8;
/// Balls that the predictor ranks: five for each ball of the pairs that are near.
/// Enough for a sphere in each pair, or four bodies of eight balls; more come on demand.
inline constexpr std::uint32_t kMaxRankedRegions = 6 * kMaxPairs;
/// A model with more index pages, about 800 B each, keeps this many, or more where there is memory.
inline constexpr std::uint32_t kLeastResidentIndexPages = 192;
/// What a point's way into a model's frame and back may be off by: a share of its distance from the
/// object's origin and of its own coordinates. Each way rounds some seven times by 1.1e-16, and
/// R^T R of a rotation may be 2e-15 from the identity.
inline constexpr double kPoseRounding = 4e-15;
/// Frames after which an unanswered wish is asked again.
inline constexpr std::uint32_t kWishTimeoutFrames = 250;

/// Arrivals taken from a model's door in one frame, whatever Budgets::pages says, and updates of
/// linked records; what a frame took is kept for recordings, 32 B each. An arrival brings few
/// updates, each one word to write; more wait for the next frame.
inline constexpr std::uint32_t kMaxArrivalsPerFrame = 64;
inline constexpr std::uint32_t kMaxLinkUpdatesPerFrame = 64;

// --- Force ---------------------------------------------------------------------------------------

/// Steps of the proxy in one frame: each ends where another triangle takes over. 2 to 6 are usual.
inline constexpr std::uint32_t kProxySteps = 24;
/// Triangles that the proxy moves among, 48 B each on the stack. With more in reach it moves less
/// far in one go.
inline constexpr std::uint32_t kMaxNearFaces = 768;
/// Times that a step is solved again with the triangle that it would enter; 2 or 3 are usual. What
/// is still entered after it shortens the step.
inline constexpr std::uint32_t kStepRounds = 16;
/// How far the proxy may sit inside the tool's radius from the surface, relative to that radius.
inline constexpr double kContactTolerance = 1e-6;
/// Planes that one motion is held back by; 5 us in six dimensions with all of them.
inline constexpr std::uint32_t kMaxHalfSpaces = 64;
/// Steps of a search for the nearest motion, in each of which a plane joins those that hold it or
/// leaves them. Awkward planes took 72 in the worst of a million searches; after half of them
/// kSqueezeTolerance is enough.
inline constexpr std::uint32_t kConstraintRounds = 128;
/// A motion may be this far beyond a plane, relative to the lengths in the question.
inline constexpr double kPlaneTolerance = 1e-12;
/// Planes whose normals are dependent to this sine are taken to be so: what is between two such
/// planes that face each other is a gap, not a wedge with an edge far away.
inline constexpr double kParallelPlanes = 1e-7;
/// Planes squeeze when their gap is too narrow by this share of the lengths; by less they fit.
inline constexpr double kSqueezeTolerance = 1e-6;
/// A tool without a radius is a ball of this many quanta, so that it has an outside.
inline constexpr double kPointSkin = 0.25;
/// Places that a tool was held at and that are remembered while it rests there; a body is held by
/// six planes at most, and some seek their place. 80 B each.
inline constexpr std::uint32_t kMaxHolds = 16;
/// A tool without a radius keeps this share of its core's, so that it can slide.
inline constexpr double kLeastSkin = 0.002;
/// Time in which a frozen force fades to zero, in seconds.
inline constexpr double kFadeTime_s = 0.05;
/// How fast the force of a proxy that had to wait for data catches up: this share of the device's
/// largest force or torque a second, but no more than so many newtons. At 1 kHz 0.8 % and 0.04 N a
/// frame.
inline constexpr double kCatchUpShare_per_s = 8.0;
inline constexpr double kCatchUp_n_per_s = 40.0;
/// Time in which a force that was off comes back, in seconds: slower than it went, so that a cause
/// that comes and goes leaves little force.
inline constexpr double kRiseTime_s = 0.1;
/// A hand that was too fast gets its force back below this share of the limit.
inline constexpr double kCalmSpeedShare = 0.5;
/// Most damping while a force fades or comes back, as a share of the device's largest force.
inline constexpr double kDampingForceShare = 0.25;
/// Share of a device's own damping that may be added by computing it. A sampled damper of b on a
/// device with damping B stays passive while b + k T / 2 < B (Colgate and Schenkel 1997), k being
/// the wall's stiffness and T the period; half leaves the other half to the wall.
inline constexpr double kDampingShare = 0.5;

// --- Stability (docs/stability.md) ---------------------------------------------------------------

/// Share of the predicted limit that a wall's stiffness may reach; no unit. Covers fractions of a
/// period in the delay (8 %) and a device's damping that is known to 10 %.
inline constexpr double kStiffnessMargin = 0.9;
/// Positions that a velocity is found from; 16 at 1 kHz tell 1/16 of a quantum a period. 32 B each.
inline constexpr std::uint32_t kVelocitySamples = 16;
/// Forces kept that may still be under way to the device; older ones count as arrived. 32 B each.
inline constexpr std::uint32_t kForcesUnderWay = 10;
/// A device that is faster has jumped: its energy is not observed. A hand makes 10 m/s at most.
inline constexpr double kDeviceSpeedMax_m_per_s = 10.0;
/// Damping that makes less force than this isn't added, in newtons: the rounding of a tool at rest.
inline constexpr double kLeastDamping_n = 1e-3;

// --- Convex tools --------------------------------------------------------------------------------

/// Vertices of a convex hull. Each answer asks for a few farthest points and each looks at all
/// vertices, 2 ns apiece; a rounder tool than 64 vertices make is given by a support function.
inline constexpr std::uint32_t kMaxHullVertices = 64;
/// Farthest points that one distance of a convex body and a triangle asks for. Hulls need 4 as a
/// rule and 15 at most in two million cases; curved bodies that nearly touch end here.
inline constexpr std::uint32_t kGjkIterations = 64;

// --- Samples of the device -----------------------------------------------------------------------

/// Goals are taken up to this coordinate, far beyond any device and any model.
inline constexpr double kGoalRange_m = 1e6;
/// How far R^T R of a tool's rotation may be from the identity, in each entry; it is made
/// orthonormal.
inline constexpr double kRotationTolerance = 1e-6;
/// How long the last sample stands in for those that don't come or can't be used. 20 periods of a
/// loop at 1 kHz; after it the force fades within kFadeTime_s.
inline constexpr double kSampleHold_s = 0.02;
/// A goal that is this many times faster than ToolSpec::speed_max_m_per_s, taken for at least
/// 1 m/s, has jumped: a hand makes 10 m/s at most.
inline constexpr double kJumpSpeeds = 100.0;

// --- Names ---------------------------------------------------------------------------------------

/// A model's or tool's name: at most this many bytes of [A-Za-z0-9._-].
inline constexpr std::size_t kMaxNameBytes = 63;

} // namespace tactus
