# tests of base
byssus_test(unit/scene/test_scene base)
