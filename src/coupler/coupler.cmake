byssus_module(coupler src/coupler/coupler.c src/coupler/coupler_exchange.c src/coupler/scheme_mass.c src/coupler/scheme_iterated.c
              src/coupler/scheme_select.c src/coupler/relaxation.c src/coupler/coupler_keys.c src/coupler/coupler_scene.c src/coupler/coupler_motion.c
              src/coupler/coupler_fill.c src/coupler/coupler_probes.c src/coupler/coupler_profile.c src/coupler/coupler_ledger.c src/coupler/coupler_state.c
              src/coupler/coupler_results.c src/coupler/coupler_fields.c src/coupler/coupler_run.c src/coupler/coupler_stop.c
              src/coupler/coupler_verify.c src/coupler/coupler_verify_static.c src/coupler/coupler_verify_dynamic.c src/coupler/coupler_verify_modes.c)
target_compile_definitions(coupler PRIVATE BYSSUS_VERSION="${PROJECT_VERSION}")
