// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

// Cyclone's plugin of access control without the checks of the program's own readers and writers,
// as an attacker with a certificate would use it. The test shows the checks of the peers.
#include <dds/dds.h>
#include <dds/security/dds_security_api_access_control.h>

#include <dlfcn.h>

namespace
{

using Begin = int (*)(const char* argument, void** context, struct ddsi_domaingv* domain);
using End = int (*)(void* context);

void* plugin()
{
    static void* const library = dlopen(TACTUS_ACCESS_CONTROL, RTLD_NOW);
    return library;
}

template <typename Function>
Function function(const char* name)
{
    return reinterpret_cast<Function>(dlsym(plugin(), name));
}

} // namespace

extern "C" __attribute__((visibility("default"))) int
init_access_control(const char* argument, void** context, struct ddsi_domaingv* domain)
{
    const int code = function<Begin>("init_access_control")(argument, context, domain);
    auto* checks = static_cast<dds_security_access_control*>(*context);
    checks->check_create_datareader = [](auto...) -> DDS_Security_boolean { return true; };
    checks->check_create_datawriter = [](auto...) -> DDS_Security_boolean { return true; };
    return code;
}

extern "C" __attribute__((visibility("default"))) int finalize_access_control(void* context)
{
    return function<End>("finalize_access_control")(context);
}
