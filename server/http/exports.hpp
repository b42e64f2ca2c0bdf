#pragma once

#include <string>

#include "server/http/message.hpp"
#include "session/snapshot.hpp"

namespace smokemap::server {

/// map.pgm and map.yaml (ROS map_server), walls.geojson (metres in `map`, not longitudes), merged.json (docs/wire.md
/// and `smokemap merge`). 404 for other names, and for maps while nothing has been seen.
Response export_file(const std::string& name, const Snapshot& snapshot);

/// `merged.json`: walls, corners, points and fit.
Json merged_document(const Snapshot& snapshot);

}  // namespace smokemap::server
