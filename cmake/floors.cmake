# SPDX-License-Identifier: Apache-2.0
# The floors of the house as data: which room may include which. cmake/checks/guards.py reads this
# file and fails on every #include that breaks it. It knows the three commands below, ${lists} and
# comments, nothing else of CMake.
#
# A room is a folder (or one file). A file belongs to the room with the longest matching path. A
# room may always include itself; an allowed name also allows the rooms below it ("rt_core" means
# every room of rt_core); "*" allows everything.
#
# tactus_room(<path> <allowed room>...)
# tactus_outside(<first part of the include's path> <room>...): a library's headers and the only
# rooms (with the rooms below them) that may include them.
# set(<list> <word>...)

# --- rt_core: stages are siblings and never include one another; they meet in query, refine, frame.
# Except that the forest hands each change straight to the tree
# (docs/internals/decisions/0005-the-frame.md).
set(stage_floor
    rt_core/base rt_core/math rt_core/limits.hpp rt_core/geometry rt_core/records rt_core/spm)

tactus_room(rt_core/base)
tactus_room(rt_core/math rt_core/base rt_core/math/seen_triangle.hpp)
# A record without inline functions: all of math that a kernel set may see.
tactus_room(rt_core/math/seen_triangle.hpp rt_core/base)
tactus_room(rt_core/geometry rt_core/base rt_core/math rt_core/limits.hpp)
tactus_room(rt_core/limits.hpp rt_core/base)
tactus_room(rt_core/spm rt_core/base rt_core/math rt_core/limits.hpp)
tactus_room(rt_core/records
    rt_core/base rt_core/math rt_core/limits.hpp rt_core/geometry rt_core/spm)
tactus_room(rt_core/cache ${stage_floor} rt_core/kernels)
tactus_room(rt_core/kernels rt_core/base rt_core/limits.hpp rt_core/math/seen_triangle.hpp)
tactus_room(rt_core/abtree ${stage_floor} rt_core/kernels)
tactus_room(rt_core/forest ${stage_floor} rt_core/abtree rt_core/kernels)
tactus_room(rt_core/predict ${stage_floor})
tactus_room(rt_core/force ${stage_floor} rt_core/kernels rt_core/query/probe.hpp)
tactus_room(rt_core/scene ${stage_floor})
tactus_room(rt_core/query ${stage_floor} rt_core/abtree rt_core/kernels rt_core/query/probe.hpp)
# How kernels see a place: what asks a tree and what moves among its faces both do.
tactus_room(rt_core/query/probe.hpp rt_core/kernels rt_core/limits.hpp rt_core/math)
tactus_room(rt_core/refine ${stage_floor}
    rt_core/abtree rt_core/forest rt_core/kernels rt_core/cache rt_core/query)
tactus_room(rt_core/frame rt_core)

# --- What every room above rt_core may use.
tactus_room(platform/base rt_core/base)

# --- platform: only the controller program sees core, transport and device; nothing includes it.
set(platform_floor
    platform/base rt_core/base rt_core/math rt_core/geometry rt_core/records rt_core/limits.hpp)

tactus_room(platform ${platform_floor})
# What devices say of themselves is judged where the rule is that uses it.
tactus_room(platform/remote platform ${platform_floor} rt_core/force)
tactus_room(platform/udp platform ${platform_floor})
tactus_room(platform/dhd platform ${platform_floor})
tactus_room(platform/plugin platform ${platform_floor})
# Frames and what they were given; of the machine it knows nothing.
tactus_room(platform/recording platform/base rt_core)
# Recordings for other tools.
tactus_room(platform/export platform/base platform/recording rt_core)
# What the machine is like; of frames and models it knows nothing.
tactus_room(platform/doctor platform)
# Pages; of what was measured it knows nothing.
tactus_room(platform/plot)
# Its command line and a scene's file are read like every other program's:
# docs/internals/decisions/0003-command-line-room.md.
tactus_room(platform/hrtc rt_core transport platform host_tools/cli host_tools/mesh
    host_tools/scene)

# --- transport: parse and link live in spm; of the cache it knows inbox and page slots.
tactus_room(transport ${stage_floor} rt_core/cache platform/base)

# What a frame and the courier beside it take together.
tactus_room(transport/pool_plan.hpp rt_core)
tactus_room(transport/pool_plan.cpp rt_core transport)
# A frame that refines all of a model, once.
tactus_room(transport/store/static_model.cpp rt_core transport platform/base)

# --- host_tools: downward only; nothing includes a program.
set(host_floor platform/base rt_core transport)

tactus_room(host_tools/cli platform/base)
tactus_room(host_tools/mesh ${host_floor})
tactus_room(host_tools/scene ${host_floor} host_tools/mesh)
tactus_room(host_tools/shapes ${host_floor} host_tools/mesh)
tactus_room(host_tools/simplify ${host_floor} host_tools/mesh)
tactus_room(host_tools/encode ${host_floor} host_tools/mesh host_tools/simplify)
tactus_room(host_tools/web ${host_floor})
# The library for other languages.
tactus_room(host_tools/c ${host_floor})
tactus_room(host_tools/python host_tools/c)
tactus_room(host_tools/spm_build ${host_floor}
    host_tools/cli host_tools/mesh host_tools/scene host_tools/shapes host_tools/simplify
    host_tools/encode)
tactus_room(host_tools/spm_inspect ${host_floor} host_tools/cli host_tools/mesh host_tools/encode)
tactus_room(host_tools/spm_publish ${host_floor} host_tools/cli host_tools/mesh host_tools/scene
    host_tools/web)

# It plays recordings.
tactus_room(host_tools/spm_view ${host_floor} host_tools/cli host_tools/mesh host_tools/encode
    host_tools/web platform/recording)

tactus_room(tests *)

# --- Libraries of others.
tactus_outside(dds transport/dds tests)
tactus_outside(ccd rt_core/query tests)
tactus_outside(Eigen rt_core platform transport host_tools tests)
tactus_outside(CLI host_tools/cli)
tactus_outside(nlohmann platform/doctor platform/hrtc platform/plot host_tools tests)
tactus_outside(fmt platform/doctor platform/export platform/plot platform/hrtc transport host_tools
    tests)
tactus_outside(assimp host_tools/mesh tests)
tactus_outside(tbb host_tools tests)
# The only doors that speak HTTP.
tactus_outside(httplib.h host_tools/spm_view host_tools/web)
tactus_outside(oneapi host_tools tests)
tactus_outside(pybind11 host_tools/python)
tactus_outside(gtest tests)
tactus_outside(rapidcheck tests)
# libsodium's one header; rt_core must not hash with it, since it may allocate.
tactus_outside(sodium.h transport host_tools platform/hrtc tests)

# --- Standard headers of rt_core: nothing that brings a heap, a clock, a thread, a file or a throw.
set(TACTUS_RT_CORE_STANDARD_HEADERS
    algorithm array atomic bit climits cmath compare concepts cstddef cstdint cstring
    initializer_list iterator limits new numbers numeric optional span string_view tuple
    type_traits utility variant immintrin.h)
