#pragma once

#include "cairn/synthetic/model.h"
#include "cairn/synthetic/models/dice.h"

// One function a class; the dice decide on sizes, proportions, kinds, colours and prints.

namespace cairn {

// tableware.cpp
Model make_cup(Dice& dice);
Model make_bottle(Dice& dice);
Model make_bowl(Dice& dice);
Model make_vase(Dice& dice);
Model make_wine_glass(Dice& dice);

// office.cpp, computers.cpp
Model make_book(Dice& dice);
Model make_keyboard(Dice& dice);
Model make_mouse(Dice& dice);
Model make_tv(Dice& dice);
Model make_laptop(Dice& dice);
Model make_cell_phone(Dice& dice);

// chairs.cpp, furniture.cpp
Model make_chair(Dice& dice);
Model make_dining_table(Dice& dice);

// cars.cpp
Model make_car(Dice& dice);

}  // namespace cairn
