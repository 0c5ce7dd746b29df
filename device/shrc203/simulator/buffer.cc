#include "device/shrc203/simulator/buffer.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace axisgate::shrc203::simulator {

Setting Setting::only(int axis) const {
  Setting part = *this;
  part.axes = {axis};
  return part;
}

void Buffer::put(Setting setting) {
  disconnect(setting.axes);
  settings_.push_back(std::move(setting));
}

void Buffer::disconnect(const Axes& axes) {
  std::erase_if(settings_, [&](Setting& setting) {
    if (!setting.axes.touches(axes)) return false;
    if (setting.indivisible()) return true;
    for (const int axis : axes.list()) setting.axes.remove(axis);
    return setting.axes.empty();
  });
}

void Buffer::split(const Axes& axes) {
  std::vector<Setting> cut_off;
  for (Setting& setting : settings_) {
    if (setting.indivisible() || !setting.axes.touches(axes) || setting.axes.within(axes)) continue;
    Setting named = setting;
    for (const int axis : setting.axes.list()) (axes.has(axis) ? setting : named).axes.remove(axis);
    cut_off.push_back(std::move(named));
  }
  std::move(cut_off.begin(), cut_off.end(), std::back_inserter(settings_));
}

const Setting* Buffer::find(Kind kind, int axis) const {
  for (const Setting& setting : settings_) {
    if (setting.kind == kind && setting.axes.has(axis)) return &setting;
  }
  return nullptr;
}

const Setting* Buffer::find(Kind kind) const {
  for (const Setting& setting : settings_) {
    if (setting.kind == kind) return &setting;
  }
  return nullptr;
}

}  // namespace axisgate::shrc203::simulator
