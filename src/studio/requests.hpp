#pragma once
#include "studio/desk.hpp"

/// Those who answer: one function a request (docs/design/studio.md). Each returns the answer without "ok", or throws
/// Trouble or Interrupted.
namespace maupertuis::studio {

/// Which arrows of forces a request wants: `forces: true` for all.
ForcesShown forces_in(const Json& request);

// text_requests.cpp
Json open_text(Desk& desk, const Work& work);
Json fixes(Desk& desk, const Work& work);
Json hover(Desk& desk, const Work& work);
Json complete(Desk& desk, const Work& work);
Json signature(Desk& desk, const Work& work);
Json definition(Desk& desk, const Work& work);
Json references(Desk& desk, const Work& work);
Json rename(Desk& desk, const Work& work);
Json format(Desk& desk, const Work& work);
Json explain(Desk& desk, const Work& work);
Json hello(Desk& desk, const Work& work);

// equation_requests.cpp
Json equations(Desk& desk, const Work& work);
Json phase_space(Desk& desk, const Work& work);
Json conserved(Desk& desk, const Work& work);
Json expectations(Desk& desk, const Work& work);

// claim_request.cpp
Json claim(Desk& desk, const Work& work);

// motion_requests.cpp
Json run(Desk& desk, const Work& work);
Json modes(Desk& desk, const Work& work);
Json section(Desk& desk, const Work& work);

// path_requests.cpp
Json paths(Desk& desk, const Work& work);

// pose.cpp
Json pose(Desk& desk, const Work& work);

// exports.cpp
Json export_file(Desk& desk, const Work& work);

}  // namespace maupertuis::studio
