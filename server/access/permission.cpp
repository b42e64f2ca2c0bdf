#include "server/access/permission.hpp"

#include <string>

#include "server/wire/commands_json.hpp"

namespace smokemap::server {
namespace {

/// The least role that may do it.
struct LeastRole {
  Role operator()(const SetLayout&) const { return Role::kCommander; }
  Role operator()(const SetStart&) const { return Role::kCommander; }
  Role operator()(const AddAnchor&) const { return Role::kCommander; }
  Role operator()(const RemoveAnchor&) const { return Role::kCommander; }
  Role operator()(const JudgeWall&) const { return Role::kCommander; }
  Role operator()(const MeasureWall&) const { return Role::kCommander; }
  Role operator()(const PinCorner&) const { return Role::kCommander; }
  Role operator()(const AddStroke&) const { return Role::kFirefighter; }
  Role operator()(const EraseStroke&) const { return Role::kFirefighter; }
  Role operator()(const ClearSketch&) const { return Role::kFirefighter; }
  Role operator()(const SetSketchSheet&) const { return Role::kFirefighter; }
  Role operator()(const JudgePair&) const { return Role::kFirefighter; }
  Role operator()(const PlacePoi&) const { return Role::kFirefighter; }
  Role operator()(const RemovePoi&) const { return Role::kFirefighter; }
  Role operator()(const SetGoal&) const { return Role::kCommander; }
  Role operator()(const CancelGoal&) const { return Role::kCommander; }
  /// Everybody may stop; only the commander sets robots free again.
  Role operator()(const EmergencyStop& stop) const { return stop.engaged ? Role::kObserver : Role::kCommander; }
  Role operator()(const SetExploring&) const { return Role::kCommander; }
};

}  // namespace

Result<Ok> may(Role role, const Command& command) {
  if (role >= std::visit(LeastRole{}, command)) return Ok{};
  const auto* stop = std::get_if<EmergencyStop>(&command);
  const std::string act = stop ? "release the emergency stop" : command_name(command);
  return fail(Errc::kForbidden, std::string("the role ") + to_string(role) + " may not " + act);
}

}  // namespace smokemap::server
