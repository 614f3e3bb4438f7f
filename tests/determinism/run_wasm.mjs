// Runs a WebAssembly program that uses only the standard streams of the system.
import {readFileSync} from 'node:fs';
import {argv, exit} from 'node:process';
import {WASI} from 'node:wasi';

const wasi = new WASI({version: 'preview1', returnOnExit: true});
const program = await WebAssembly.compile(readFileSync(argv[2]));
exit(wasi.start(await WebAssembly.instantiate(program, wasi.getImportObject())));
