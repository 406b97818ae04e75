var hr={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},ur={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},Nm=0,Rd=1,Om=2;var Ir=1,Um=2,Vo=3,dr=0,Yn=1,Mn=2,Lr=0,Go=1,Pd=2,Id=3,Ld=4,Fm=5;var Dr=100,Bm=101,km=102,zm=103,Vm=104,Gm=200,Hm=201,Wm=202,Xm=203,Dd=204,Nd=205,Ym=206,qm=207,$m=208,Zm=209,Jm=210,jm=211,Km=212,Qm=213,tg=214,_c=0,xc=1,yc=2,Ao=3,vc=4,Sc=5,Mc=6,wc=7,qc=0,eg=1,ng=2,ds=0,Od=1,Ud=2,Fd=3,Bd=4,kd=5,zd=6,Vd=7;var Gd=300,Nr=301,Ho=302,$c=303,Zc=304,Co=1e3,hs=1001,bc=1002,zn=1003,ig=1004;var ol=1005;var ci=1006,Jc=1007;var ks=1008;var _i=1009,Hd=1010,Wd=1011,Wo=1012,jc=1013,Zi=1014,Fi=1015,Ji=1016,Kc=1017,Qc=1018,Or=1020,Xd=35902,Yd=35899,qd=1021,$d=1022,ji=1023,Ds=1026,zs=1027,th=1028,eh=1029,fr=1030,nh=1031;var ih=1033,al=33776,ll=33777,cl=33778,hl=33779,sh=35840,rh=35841,oh=35842,ah=35843,lh=36196,ch=37492,hh=37496,uh=37488,dh=37489,ul=37490,fh=37491,ph=37808,mh=37809,gh=37810,_h=37811,xh=37812,yh=37813,vh=37814,Sh=37815,Mh=37816,wh=37817,bh=37818,Th=37819,Eh=37820,Ah=37821,Ch=36492,Rh=36494,Ph=36495,Ih=36283,Lh=36284,dl=36285,Dh=36286;var Pa=2300,Tc=2301,mc=2302,xd=2303,yd=2400,vd=2401,Sd=2402;var sg=3200;var fl=0,rg=1,Vs="",Te="srgb",Ia="srgb-linear",La="linear",Ie="srgb";var gc=7680;var og=519,ag=512,lg=513,cg=514,Zd=515,hg=516,ug=517,Jd=518,jd=519,Kd=35044;var Qd="300 es",Oi=2e3,Ro=2001;function iy(i){for(let t=i.length-1;t>=0;--t)if(i[t]>=65535)return!0;return!1}function sy(i){return ArrayBuffer.isView(i)&&!(i instanceof DataView)}function Da(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function dg(){let i=Da("canvas");return i.style.display="block",i}var $p={},Po=null;function Na(...i){let t="THREE."+i.shift();Po?Po("log",t,...i):console.log(t,...i)}function fg(i){let t=i[0];if(typeof t=="string"&&t.startsWith("TSL:")){let e=i[1];e&&e.isStackTrace?i[0]+=" "+e.getLocation():i[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return i}function jt(...i){i=fg(i);let t="THREE."+i.shift();if(Po)Po("warn",t,...i);else{let e=i[0];e&&e.isStackTrace?console.warn(e.getError(t)):console.warn(t,...i)}}function te(...i){i=fg(i);let t="THREE."+i.shift();if(Po)Po("error",t,...i);else{let e=i[0];e&&e.isStackTrace?console.error(e.getError(t)):console.error(t,...i)}}function Aa(...i){let t=i.join(" ");t in $p||($p[t]=!0,jt(...i))}function pg(i,t,e){return new Promise(function(n,s){function r(){switch(i.clientWaitSync(t,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(r,e);break;default:n()}}setTimeout(r,e)})}var mg={[_c]:_c,[yc]:Mc,[vc]:vc,[Ao]:Sc,[xc]:xc,[Mc]:yc,[wc]:wc,[Sc]:Ao},$i=class{addEventListener(t,e){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[t]===void 0&&(n[t]=[]),n[t].indexOf(e)===-1&&n[t].push(e)}hasEventListener(t,e){let n=this._listeners;return n===void 0?!1:n[t]!==void 0&&n[t].indexOf(e)!==-1}removeEventListener(t,e){let n=this._listeners;if(n===void 0)return;let s=n[t];if(s!==void 0){let r=s.indexOf(e);r!==-1&&s.splice(r,1)}}dispatchEvent(t){let e=this._listeners;if(e===void 0)return;let n=e[t.type];if(n!==void 0){t.target=this;let s=n.slice(0);for(let r=0,o=s.length;r<o;r++)s[r].call(this,t);t.target=null}}},jn=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],Zp=1234567,Ca=Math.PI/180,Er=180/Math.PI;function pr(){let i=Math.random()*4294967295|0,t=Math.random()*4294967295|0,e=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(jn[i&255]+jn[i>>8&255]+jn[i>>16&255]+jn[i>>24&255]+"-"+jn[t&255]+jn[t>>8&255]+"-"+jn[t>>16&15|64]+jn[t>>24&255]+"-"+jn[e&63|128]+jn[e>>8&255]+"-"+jn[e>>16&255]+jn[e>>24&255]+jn[n&255]+jn[n>>8&255]+jn[n>>16&255]+jn[n>>24&255]).toLowerCase()}function he(i,t,e){return Math.max(t,Math.min(e,i))}function tf(i,t){return(i%t+t)%t}function ry(i,t,e,n,s){return n+(i-t)*(s-n)/(e-t)}function oy(i,t,e){return i!==t?(e-i)/(t-i):0}function Ra(i,t,e){return(1-e)*i+e*t}function ay(i,t,e,n){return Ra(i,t,1-Math.exp(-e*n))}function ly(i,t=1){return t-Math.abs(tf(i,t*2)-t)}function cy(i,t,e){return i<=t?0:i>=e?1:(i=(i-t)/(e-t),i*i*(3-2*i))}function hy(i,t,e){return i<=t?0:i>=e?1:(i=(i-t)/(e-t),i*i*i*(i*(i*6-15)+10))}function uy(i,t){return i+Math.floor(Math.random()*(t-i+1))}function dy(i,t){return i+Math.random()*(t-i)}function fy(i){return i*(.5-Math.random())}function py(i){i!==void 0&&(Zp=i);let t=Zp+=1831565813;return t=Math.imul(t^t>>>15,t|1),t^=t+Math.imul(t^t>>>7,t|61),((t^t>>>14)>>>0)/4294967296}function my(i){return i*Ca}function gy(i){return i*Er}function _y(i){return i>0&&Number.isInteger(i)&&2**Math.round(Math.log2(i))===i}function xy(i){return Math.pow(2,Math.ceil(Math.log(i)/Math.LN2))}function ef(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function yy(i,t,e,n,s){let r=Math.cos,o=Math.sin,a=r(e/2),l=o(e/2),c=r((t+n)/2),d=o((t+n)/2),h=r((t-n)/2),u=o((t-n)/2),f=r((n-t)/2),p=o((n-t)/2);switch(s){case"XYX":i.set(a*d,l*h,l*u,a*c);break;case"YZY":i.set(l*u,a*d,l*h,a*c);break;case"ZXZ":i.set(l*h,l*u,a*d,a*c);break;case"XZX":i.set(a*d,l*p,l*f,a*c);break;case"YXY":i.set(l*f,a*d,l*p,a*c);break;case"ZYZ":i.set(l*p,l*f,a*d,a*c);break;default:jt("MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function Nh(i){switch(i.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function nf(i,t){if(t.constructor===Float32Array)return i;let e=Nh(t);if(e===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(i/e,-1)}function sf(i,t){if(t.constructor===Float32Array)return i;let e=Nh(t);if(e===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(i*e)}var pl={DEG2RAD:Ca,RAD2DEG:Er,generateUUID:pr,clamp:he,euclideanModulo:tf,mapLinear:ry,inverseLerp:oy,lerp:Ra,damp:ay,pingpong:ly,smoothstep:cy,smootherstep:hy,randInt:uy,randFloat:dy,randFloatSpread:fy,seededRandom:py,degToRad:my,radToDeg:gy,isPowerOfTwo:_y,ceilPowerOfTwo:xy,floorPowerOfTwo:ef,setQuaternionFromProperEuler:yy,normalize:sf,denormalize:nf},Bt=class{static{this.prototype.isVector2=!0}constructor(t=0,e=0){this.x=t,this.y=e}get width(){return this.x}set width(t){this.x=t}get height(){return this.y}set height(t){this.y=t}set(t,e){return this.x=t,this.y=e,this}setScalar(t){return this.x=t,this.y=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;default:throw new Error("THREE.Vector2: index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y)}copy(t){return this.x=t.x,this.y=t.y,this}add(t){return this.x+=t.x,this.y+=t.y,this}addScalar(t){return this.x+=t,this.y+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this}subScalar(t){return this.x-=t,this.y-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this}multiply(t){return this.x*=t.x,this.y*=t.y,this}multiplyScalar(t){return this.x*=t,this.y*=t,this}divide(t){return this.x/=t.x,this.y/=t.y,this}divideScalar(t){return this.multiplyScalar(1/t)}applyMatrix3(t){let e=this.x,n=this.y,s=t.elements;return this.x=s[0]*e+s[3]*n+s[6],this.y=s[1]*e+s[4]*n+s[7],this}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this}clamp(t,e){return this.x=he(this.x,t.x,e.x),this.y=he(this.y,t.y,e.y),this}clampScalar(t,e){return this.x=he(this.x,t,e),this.y=he(this.y,t,e),this}clampLength(t,e){let n=this.length();return this.divideScalar(n||1).multiplyScalar(he(n,t,e))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(t){return this.x*t.x+this.y*t.y}cross(t){return this.x*t.y-this.y*t.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(t){let e=Math.sqrt(this.lengthSq()*t.lengthSq());if(e===0)return Math.PI/2;let n=this.dot(t)/e;return Math.acos(he(n,-1,1))}distanceTo(t){return Math.sqrt(this.distanceToSquared(t))}distanceToSquared(t){let e=this.x-t.x,n=this.y-t.y;return e*e+n*n}manhattanDistanceTo(t){return Math.abs(this.x-t.x)+Math.abs(this.y-t.y)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this}equals(t){return t.x===this.x&&t.y===this.y}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this}rotateAround(t,e){let n=Math.cos(e),s=Math.sin(e),r=this.x-t.x,o=this.y-t.y;return this.x=r*n-o*s+t.x,this.y=r*s+o*n+t.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},ze=class{constructor(t=0,e=0,n=0,s=1){this.isQuaternion=!0,this._x=t,this._y=e,this._z=n,this._w=s}static slerpFlat(t,e,n,s,r,o,a){let l=n[s+0],c=n[s+1],d=n[s+2],h=n[s+3],u=r[o+0],f=r[o+1],p=r[o+2],_=r[o+3];if(h!==_||l!==u||c!==f||d!==p){let m=l*u+c*f+d*p+h*_;m<0&&(u=-u,f=-f,p=-p,_=-_,m=-m);let g=1-a;if(m<.9995){let y=Math.acos(m),T=Math.sin(y);g=Math.sin(g*y)/T,a=Math.sin(a*y)/T,l=l*g+u*a,c=c*g+f*a,d=d*g+p*a,h=h*g+_*a}else{l=l*g+u*a,c=c*g+f*a,d=d*g+p*a,h=h*g+_*a;let y=1/Math.sqrt(l*l+c*c+d*d+h*h);l*=y,c*=y,d*=y,h*=y}}t[e]=l,t[e+1]=c,t[e+2]=d,t[e+3]=h}static multiplyQuaternionsFlat(t,e,n,s,r,o){let a=n[s],l=n[s+1],c=n[s+2],d=n[s+3],h=r[o],u=r[o+1],f=r[o+2],p=r[o+3];return t[e]=a*p+d*h+l*f-c*u,t[e+1]=l*p+d*u+c*h-a*f,t[e+2]=c*p+d*f+a*u-l*h,t[e+3]=d*p-a*h-l*u-c*f,t}get x(){return this._x}set x(t){this._x=t,this._onChangeCallback()}get y(){return this._y}set y(t){this._y=t,this._onChangeCallback()}get z(){return this._z}set z(t){this._z=t,this._onChangeCallback()}get w(){return this._w}set w(t){this._w=t,this._onChangeCallback()}set(t,e,n,s){return this._x=t,this._y=e,this._z=n,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(t){return this._x=t.x,this._y=t.y,this._z=t.z,this._w=t.w,this._onChangeCallback(),this}setFromEuler(t,e=!0){let n=t._x,s=t._y,r=t._z,o=t._order,a=Math.cos,l=Math.sin,c=a(n/2),d=a(s/2),h=a(r/2),u=l(n/2),f=l(s/2),p=l(r/2);switch(o){case"XYZ":this._x=u*d*h+c*f*p,this._y=c*f*h-u*d*p,this._z=c*d*p+u*f*h,this._w=c*d*h-u*f*p;break;case"YXZ":this._x=u*d*h+c*f*p,this._y=c*f*h-u*d*p,this._z=c*d*p-u*f*h,this._w=c*d*h+u*f*p;break;case"ZXY":this._x=u*d*h-c*f*p,this._y=c*f*h+u*d*p,this._z=c*d*p+u*f*h,this._w=c*d*h-u*f*p;break;case"ZYX":this._x=u*d*h-c*f*p,this._y=c*f*h+u*d*p,this._z=c*d*p-u*f*h,this._w=c*d*h+u*f*p;break;case"YZX":this._x=u*d*h+c*f*p,this._y=c*f*h+u*d*p,this._z=c*d*p-u*f*h,this._w=c*d*h-u*f*p;break;case"XZY":this._x=u*d*h-c*f*p,this._y=c*f*h-u*d*p,this._z=c*d*p+u*f*h,this._w=c*d*h+u*f*p;break;default:jt("Quaternion: .setFromEuler() encountered an unknown order: "+o)}return e===!0&&this._onChangeCallback(),this}setFromAxisAngle(t,e){let n=e/2,s=Math.sin(n);return this._x=t.x*s,this._y=t.y*s,this._z=t.z*s,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(t){let e=t.elements,n=e[0],s=e[4],r=e[8],o=e[1],a=e[5],l=e[9],c=e[2],d=e[6],h=e[10],u=n+a+h;if(u>0){let f=.5/Math.sqrt(u+1);this._w=.25/f,this._x=(d-l)*f,this._y=(r-c)*f,this._z=(o-s)*f}else if(n>a&&n>h){let f=2*Math.sqrt(1+n-a-h);this._w=(d-l)/f,this._x=.25*f,this._y=(s+o)/f,this._z=(r+c)/f}else if(a>h){let f=2*Math.sqrt(1+a-n-h);this._w=(r-c)/f,this._x=(s+o)/f,this._y=.25*f,this._z=(l+d)/f}else{let f=2*Math.sqrt(1+h-n-a);this._w=(o-s)/f,this._x=(r+c)/f,this._y=(l+d)/f,this._z=.25*f}return this._onChangeCallback(),this}setFromUnitVectors(t,e){let n=t.dot(e)+1;return n<1e-8?(n=0,Math.abs(t.x)>Math.abs(t.z)?(this._x=-t.y,this._y=t.x,this._z=0,this._w=n):(this._x=0,this._y=-t.z,this._z=t.y,this._w=n)):(this._x=t.y*e.z-t.z*e.y,this._y=t.z*e.x-t.x*e.z,this._z=t.x*e.y-t.y*e.x,this._w=n),this.normalize()}angleTo(t){return 2*Math.acos(Math.abs(he(this.dot(t),-1,1)))}rotateTowards(t,e){let n=this.angleTo(t);if(n===0)return this;let s=Math.min(1,e/n);return this.slerp(t,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(t){return this._x*t._x+this._y*t._y+this._z*t._z+this._w*t._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let t=this.length();return t===0?(this._x=0,this._y=0,this._z=0,this._w=1):(t=1/t,this._x=this._x*t,this._y=this._y*t,this._z=this._z*t,this._w=this._w*t),this._onChangeCallback(),this}multiply(t){return this.multiplyQuaternions(this,t)}premultiply(t){return this.multiplyQuaternions(t,this)}multiplyQuaternions(t,e){let n=t._x,s=t._y,r=t._z,o=t._w,a=e._x,l=e._y,c=e._z,d=e._w;return this._x=n*d+o*a+s*c-r*l,this._y=s*d+o*l+r*a-n*c,this._z=r*d+o*c+n*l-s*a,this._w=o*d-n*a-s*l-r*c,this._onChangeCallback(),this}slerp(t,e){let n=t._x,s=t._y,r=t._z,o=t._w,a=this.dot(t);a<0&&(n=-n,s=-s,r=-r,o=-o,a=-a);let l=1-e;if(a<.9995){let c=Math.acos(a),d=Math.sin(c);l=Math.sin(l*c)/d,e=Math.sin(e*c)/d,this._x=this._x*l+n*e,this._y=this._y*l+s*e,this._z=this._z*l+r*e,this._w=this._w*l+o*e,this._onChangeCallback()}else this._x=this._x*l+n*e,this._y=this._y*l+s*e,this._z=this._z*l+r*e,this._w=this._w*l+o*e,this.normalize();return this}slerpQuaternions(t,e,n){return this.copy(t).slerp(e,n)}random(){let t=2*Math.PI*Math.random(),e=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),r=Math.sqrt(n);return this.set(s*Math.sin(t),s*Math.cos(t),r*Math.sin(e),r*Math.cos(e))}equals(t){return t._x===this._x&&t._y===this._y&&t._z===this._z&&t._w===this._w}fromArray(t,e=0){return this._x=t[e],this._y=t[e+1],this._z=t[e+2],this._w=t[e+3],this._onChangeCallback(),this}toArray(t=[],e=0){return t[e]=this._x,t[e+1]=this._y,t[e+2]=this._z,t[e+3]=this._w,t}fromBufferAttribute(t,e){return this._x=t.getX(e),this._y=t.getY(e),this._z=t.getZ(e),this._w=t.getW(e),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(t){return this._onChangeCallback=t,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},R=class{static{this.prototype.isVector3=!0}constructor(t=0,e=0,n=0){this.x=t,this.y=e,this.z=n}set(t,e,n){return n===void 0&&(n=this.z),this.x=t,this.y=e,this.z=n,this}setScalar(t){return this.x=t,this.y=t,this.z=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setZ(t){return this.z=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;case 2:this.z=e;break;default:throw new Error("THREE.Vector3: index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(t){return this.x=t.x,this.y=t.y,this.z=t.z,this}add(t){return this.x+=t.x,this.y+=t.y,this.z+=t.z,this}addScalar(t){return this.x+=t,this.y+=t,this.z+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this.z=t.z+e.z,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this.z+=t.z*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this.z-=t.z,this}subScalar(t){return this.x-=t,this.y-=t,this.z-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this.z=t.z-e.z,this}multiply(t){return this.x*=t.x,this.y*=t.y,this.z*=t.z,this}multiplyScalar(t){return this.x*=t,this.y*=t,this.z*=t,this}multiplyVectors(t,e){return this.x=t.x*e.x,this.y=t.y*e.y,this.z=t.z*e.z,this}applyEuler(t){return this.applyQuaternion(Jp.setFromEuler(t))}applyAxisAngle(t,e){return this.applyQuaternion(Jp.setFromAxisAngle(t,e))}applyMatrix3(t){let e=this.x,n=this.y,s=this.z,r=t.elements;return this.x=r[0]*e+r[3]*n+r[6]*s,this.y=r[1]*e+r[4]*n+r[7]*s,this.z=r[2]*e+r[5]*n+r[8]*s,this}applyNormalMatrix(t){return this.applyMatrix3(t).normalize()}applyMatrix4(t){let e=this.x,n=this.y,s=this.z,r=t.elements,o=1/(r[3]*e+r[7]*n+r[11]*s+r[15]);return this.x=(r[0]*e+r[4]*n+r[8]*s+r[12])*o,this.y=(r[1]*e+r[5]*n+r[9]*s+r[13])*o,this.z=(r[2]*e+r[6]*n+r[10]*s+r[14])*o,this}applyQuaternion(t){let e=this.x,n=this.y,s=this.z,r=t.x,o=t.y,a=t.z,l=t.w,c=2*(o*s-a*n),d=2*(a*e-r*s),h=2*(r*n-o*e);return this.x=e+l*c+o*h-a*d,this.y=n+l*d+a*c-r*h,this.z=s+l*h+r*d-o*c,this}project(t){return this.applyMatrix4(t.matrixWorldInverse).applyMatrix4(t.projectionMatrix)}unproject(t){return this.applyMatrix4(t.projectionMatrixInverse).applyMatrix4(t.matrixWorld)}transformDirection(t){let e=this.x,n=this.y,s=this.z,r=t.elements;return this.x=r[0]*e+r[4]*n+r[8]*s,this.y=r[1]*e+r[5]*n+r[9]*s,this.z=r[2]*e+r[6]*n+r[10]*s,this.normalize()}divide(t){return this.x/=t.x,this.y/=t.y,this.z/=t.z,this}divideScalar(t){return this.multiplyScalar(1/t)}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this.z=Math.min(this.z,t.z),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this.z=Math.max(this.z,t.z),this}clamp(t,e){return this.x=he(this.x,t.x,e.x),this.y=he(this.y,t.y,e.y),this.z=he(this.z,t.z,e.z),this}clampScalar(t,e){return this.x=he(this.x,t,e),this.y=he(this.y,t,e),this.z=he(this.z,t,e),this}clampLength(t,e){let n=this.length();return this.divideScalar(n||1).multiplyScalar(he(n,t,e))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(t){return this.x*t.x+this.y*t.y+this.z*t.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this.z+=(t.z-this.z)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this.z=t.z+(e.z-t.z)*n,this}cross(t){return this.crossVectors(this,t)}crossVectors(t,e){let n=t.x,s=t.y,r=t.z,o=e.x,a=e.y,l=e.z;return this.x=s*l-r*a,this.y=r*o-n*l,this.z=n*a-s*o,this}projectOnVector(t){let e=t.lengthSq();if(e===0)return this.set(0,0,0);let n=t.dot(this)/e;return this.copy(t).multiplyScalar(n)}projectOnPlane(t){return $u.copy(this).projectOnVector(t),this.sub($u)}reflect(t){return this.sub($u.copy(t).multiplyScalar(2*this.dot(t)))}angleTo(t){let e=Math.sqrt(this.lengthSq()*t.lengthSq());if(e===0)return Math.PI/2;let n=this.dot(t)/e;return Math.acos(he(n,-1,1))}distanceTo(t){return Math.sqrt(this.distanceToSquared(t))}distanceToSquared(t){let e=this.x-t.x,n=this.y-t.y,s=this.z-t.z;return e*e+n*n+s*s}manhattanDistanceTo(t){return Math.abs(this.x-t.x)+Math.abs(this.y-t.y)+Math.abs(this.z-t.z)}setFromSpherical(t){return this.setFromSphericalCoords(t.radius,t.phi,t.theta)}setFromSphericalCoords(t,e,n){let s=Math.sin(e)*t;return this.x=s*Math.sin(n),this.y=Math.cos(e)*t,this.z=s*Math.cos(n),this}setFromCylindrical(t){return this.setFromCylindricalCoords(t.radius,t.theta,t.y)}setFromCylindricalCoords(t,e,n){return this.x=t*Math.sin(e),this.y=n,this.z=t*Math.cos(e),this}setFromMatrixPosition(t){let e=t.elements;return this.x=e[12],this.y=e[13],this.z=e[14],this}setFromMatrixScale(t){let e=this.setFromMatrixColumn(t,0).length(),n=this.setFromMatrixColumn(t,1).length(),s=this.setFromMatrixColumn(t,2).length();return this.x=e,this.y=n,this.z=s,this}setFromMatrixColumn(t,e){return this.fromArray(t.elements,e*4)}setFromMatrix3Column(t,e){return this.fromArray(t.elements,e*3)}setFromEuler(t){return this.x=t._x,this.y=t._y,this.z=t._z,this}setFromColor(t){return this.x=t.r,this.y=t.g,this.z=t.b,this}equals(t){return t.x===this.x&&t.y===this.y&&t.z===this.z}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this.z=t[e+2],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t[e+2]=this.z,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this.z=t.getZ(e),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let t=Math.random()*Math.PI*2,e=Math.random()*2-1,n=Math.sqrt(1-e*e);return this.x=n*Math.cos(t),this.y=e,this.z=n*Math.sin(t),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},$u=new R,Jp=new ze,re=class{static{this.prototype.isMatrix3=!0}constructor(t,e,n,s,r,o,a,l,c){this.elements=[1,0,0,0,1,0,0,0,1],t!==void 0&&this.set(t,e,n,s,r,o,a,l,c)}set(t,e,n,s,r,o,a,l,c){let d=this.elements;return d[0]=t,d[1]=s,d[2]=a,d[3]=e,d[4]=r,d[5]=l,d[6]=n,d[7]=o,d[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(t){let e=this.elements,n=t.elements;return e[0]=n[0],e[1]=n[1],e[2]=n[2],e[3]=n[3],e[4]=n[4],e[5]=n[5],e[6]=n[6],e[7]=n[7],e[8]=n[8],this}extractBasis(t,e,n){return t.setFromMatrix3Column(this,0),e.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(t){let e=t.elements;return this.set(e[0],e[4],e[8],e[1],e[5],e[9],e[2],e[6],e[10]),this}multiply(t){return this.multiplyMatrices(this,t)}premultiply(t){return this.multiplyMatrices(t,this)}multiplyMatrices(t,e){let n=t.elements,s=e.elements,r=this.elements,o=n[0],a=n[3],l=n[6],c=n[1],d=n[4],h=n[7],u=n[2],f=n[5],p=n[8],_=s[0],m=s[3],g=s[6],y=s[1],T=s[4],v=s[7],M=s[2],b=s[5],x=s[8];return r[0]=o*_+a*y+l*M,r[3]=o*m+a*T+l*b,r[6]=o*g+a*v+l*x,r[1]=c*_+d*y+h*M,r[4]=c*m+d*T+h*b,r[7]=c*g+d*v+h*x,r[2]=u*_+f*y+p*M,r[5]=u*m+f*T+p*b,r[8]=u*g+f*v+p*x,this}multiplyScalar(t){let e=this.elements;return e[0]*=t,e[3]*=t,e[6]*=t,e[1]*=t,e[4]*=t,e[7]*=t,e[2]*=t,e[5]*=t,e[8]*=t,this}determinant(){let t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],o=t[4],a=t[5],l=t[6],c=t[7],d=t[8];return e*o*d-e*a*c-n*r*d+n*a*l+s*r*c-s*o*l}invert(){let t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],o=t[4],a=t[5],l=t[6],c=t[7],d=t[8],h=d*o-a*c,u=a*l-d*r,f=c*r-o*l,p=e*h+n*u+s*f;if(p===0)return this.set(0,0,0,0,0,0,0,0,0);let _=1/p;return t[0]=h*_,t[1]=(s*c-d*n)*_,t[2]=(a*n-s*o)*_,t[3]=u*_,t[4]=(d*e-s*l)*_,t[5]=(s*r-a*e)*_,t[6]=f*_,t[7]=(n*l-c*e)*_,t[8]=(o*e-n*r)*_,this}transpose(){let t,e=this.elements;return t=e[1],e[1]=e[3],e[3]=t,t=e[2],e[2]=e[6],e[6]=t,t=e[5],e[5]=e[7],e[7]=t,this}getNormalMatrix(t){return this.setFromMatrix4(t).invert().transpose()}transposeIntoArray(t){let e=this.elements;return t[0]=e[0],t[1]=e[3],t[2]=e[6],t[3]=e[1],t[4]=e[4],t[5]=e[7],t[6]=e[2],t[7]=e[5],t[8]=e[8],this}setUvTransform(t,e,n,s,r,o,a){let l=Math.cos(r),c=Math.sin(r);return this.set(n*l,n*c,-n*(l*o+c*a)+o+t,-s*c,s*l,-s*(-c*o+l*a)+a+e,0,0,1),this}scale(t,e){return Aa("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(Zu.makeScale(t,e)),this}rotate(t){return Aa("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(Zu.makeRotation(-t)),this}translate(t,e){return Aa("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(Zu.makeTranslation(t,e)),this}makeTranslation(t,e){return t.isVector2?this.set(1,0,t.x,0,1,t.y,0,0,1):this.set(1,0,t,0,1,e,0,0,1),this}makeRotation(t){let e=Math.cos(t),n=Math.sin(t);return this.set(e,-n,0,n,e,0,0,0,1),this}makeScale(t,e){return this.set(t,0,0,0,e,0,0,0,1),this}equals(t){let e=this.elements,n=t.elements;for(let s=0;s<9;s++)if(e[s]!==n[s])return!1;return!0}fromArray(t,e=0){for(let n=0;n<9;n++)this.elements[n]=t[n+e];return this}toArray(t=[],e=0){let n=this.elements;return t[e]=n[0],t[e+1]=n[1],t[e+2]=n[2],t[e+3]=n[3],t[e+4]=n[4],t[e+5]=n[5],t[e+6]=n[6],t[e+7]=n[7],t[e+8]=n[8],t}clone(){return new this.constructor().fromArray(this.elements)}},Zu=new re,jp=new re().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),Kp=new re().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function vy(){let i={enabled:!0,workingColorSpace:Ia,spaces:{},convert:function(s,r,o){return this.enabled===!1||r===o||!r||!o||(this.spaces[r].transfer===Ie&&(s.r=Ls(s.r),s.g=Ls(s.g),s.b=Ls(s.b)),this.spaces[r].primaries!==this.spaces[o].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[o].fromXYZ)),this.spaces[o].transfer===Ie&&(s.r=Eo(s.r),s.g=Eo(s.g),s.b=Eo(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===Vs?La:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,r,o){return s.copy(this.spaces[o].fromXYZ).multiply(this.spaces[r].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},t=[.64,.33,.3,.6,.15,.06],e=[.2126,.7152,.0722],n=[.3127,.329];return i.define({[Ia]:{primaries:t,whitePoint:n,transfer:La,toXYZ:jp,fromXYZ:Kp,luminanceCoefficients:e,workingColorSpaceConfig:{unpackColorSpace:Te},outputColorSpaceConfig:{drawingBufferColorSpace:Te}},[Te]:{primaries:t,whitePoint:n,transfer:Ie,toXYZ:jp,fromXYZ:Kp,luminanceCoefficients:e,outputColorSpaceConfig:{drawingBufferColorSpace:Te}}}),i}var Se=vy();function Ls(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function Eo(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}var ro,Ec=class{static getDataURL(t,e="image/png"){if(/^data:/i.test(t.src)||typeof HTMLCanvasElement>"u")return t.src;let n;if(t instanceof HTMLCanvasElement)n=t;else{ro===void 0&&(ro=Da("canvas")),ro.width=t.width,ro.height=t.height;let s=ro.getContext("2d");t instanceof ImageData?s.putImageData(t,0,0):s.drawImage(t,0,0,t.width,t.height),n=ro}return n.toDataURL(e)}static sRGBToLinear(t){if(typeof HTMLImageElement<"u"&&t instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&t instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&t instanceof ImageBitmap){let e=Da("canvas");e.width=t.width,e.height=t.height;let n=e.getContext("2d");n.drawImage(t,0,0,t.width,t.height);let s=n.getImageData(0,0,t.width,t.height),r=s.data;for(let o=0;o<r.length;o++)r[o]=Ls(r[o]/255)*255;return n.putImageData(s,0,0),e}else if(t.data){let e=t.data.slice(0);for(let n=0;n<e.length;n++)e instanceof Uint8Array||e instanceof Uint8ClampedArray?e[n]=Math.floor(Ls(e[n]/255)*255):e[n]=Ls(e[n]);return{data:e,width:t.width,height:t.height}}else return jt("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),t}},Sy=0,Io=class{constructor(t=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:Sy++}),this.uuid=pr(),this.data=t,this.dataReady=!0,this.version=0}getSize(t){let e=this.data;return typeof HTMLVideoElement<"u"&&e instanceof HTMLVideoElement?t.set(e.videoWidth,e.videoHeight,0):typeof VideoFrame<"u"&&e instanceof VideoFrame?t.set(e.displayWidth,e.displayHeight,0):e!==null?t.set(e.width||0,e.height||0,e.depth||0):t.set(0,0,0),t}set needsUpdate(t){t===!0&&this.version++}toJSON(t){let e=t===void 0||typeof t=="string";if(!e&&t.images[this.uuid]!==void 0)return t.images[this.uuid];let n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let o=0,a=s.length;o<a;o++)s[o].isDataTexture?r.push(Ju(s[o].image)):r.push(Ju(s[o]))}else r=Ju(s);n.url=r}return e||(t.images[this.uuid]=n),n}};function Ju(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?Ec.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:(jt("Texture: Unable to serialize Texture."),{})}var My=0,ju=new R,Wn=class i extends $i{constructor(t=i.DEFAULT_IMAGE,e=i.DEFAULT_MAPPING,n=hs,s=hs,r=ci,o=ks,a=ji,l=_i,c=i.DEFAULT_ANISOTROPY,d=Vs){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:My++}),this.uuid=pr(),this.name="",this.source=new Io(t),this.mipmaps=[],this.mapping=e,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=r,this.minFilter=o,this.anisotropy=c,this.format=a,this.internalFormat=null,this.type=l,this.offset=new Bt(0,0),this.repeat=new Bt(1,1),this.center=new Bt(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new re,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=d,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(t&&t.depth&&t.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(ju).x}get height(){return this.source.getSize(ju).y}get depth(){return this.source.getSize(ju).z}get image(){return this.source.data}set image(t){this.source.data=t}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(t,e){this.updateRanges.push({start:t,count:e})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(t){return this.name=t.name,this.source=t.source,this.mipmaps=t.mipmaps.slice(0),this.mapping=t.mapping,this.channel=t.channel,this.wrapS=t.wrapS,this.wrapT=t.wrapT,this.magFilter=t.magFilter,this.minFilter=t.minFilter,this.anisotropy=t.anisotropy,this.format=t.format,this.internalFormat=t.internalFormat,this.type=t.type,this.normalized=t.normalized,this.offset.copy(t.offset),this.repeat.copy(t.repeat),this.center.copy(t.center),this.rotation=t.rotation,this.matrixAutoUpdate=t.matrixAutoUpdate,this.matrix.copy(t.matrix),this.generateMipmaps=t.generateMipmaps,this.mipmapsAutoUpdate=t.mipmapsAutoUpdate,this.premultiplyAlpha=t.premultiplyAlpha,this.flipY=t.flipY,this.unpackAlignment=t.unpackAlignment,this.colorSpace=t.colorSpace,this.renderTarget=t.renderTarget,this.isRenderTargetTexture=t.isRenderTargetTexture,this.isPMREMTexture=t.isPMREMTexture,this.isArrayTexture=t.isArrayTexture,this.userData=JSON.parse(JSON.stringify(t.userData)),this.needsUpdate=!0,this}setValues(t){for(let e in t){let n=t[e];if(n===void 0){jt(`Texture.setValues(): parameter '${e}' has value of undefined.`);continue}let s=this[e];if(s===void 0){jt(`Texture.setValues(): property '${e}' does not exist.`);continue}s&&n&&s.isVector2&&n.isVector2||s&&n&&s.isVector3&&n.isVector3||s&&n&&s.isMatrix3&&n.isMatrix3?s.copy(n):this[e]=n}}toJSON(t){let e=t===void 0||typeof t=="string";if(!e&&t.textures[this.uuid]!==void 0)return t.textures[this.uuid];let n={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(t).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),e||(t.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(t){if(this.mapping!==Gd)return t;if(t.applyMatrix3(this.matrix),t.x<0||t.x>1)switch(this.wrapS){case Co:t.x=t.x-Math.floor(t.x);break;case hs:t.x=t.x<0?0:1;break;case bc:Math.abs(Math.floor(t.x)%2)===1?t.x=Math.ceil(t.x)-t.x:t.x=t.x-Math.floor(t.x);break}if(t.y<0||t.y>1)switch(this.wrapT){case Co:t.y=t.y-Math.floor(t.y);break;case hs:t.y=t.y<0?0:1;break;case bc:Math.abs(Math.floor(t.y)%2)===1?t.y=Math.ceil(t.y)-t.y:t.y=t.y-Math.floor(t.y);break}return this.flipY&&(t.y=1-t.y),t}set needsUpdate(t){t===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(t){t===!0&&this.pmremVersion++}};Wn.DEFAULT_IMAGE=null;Wn.DEFAULT_MAPPING=Gd;Wn.DEFAULT_ANISOTROPY=1;var De=class{static{this.prototype.isVector4=!0}constructor(t=0,e=0,n=0,s=1){this.x=t,this.y=e,this.z=n,this.w=s}get width(){return this.z}set width(t){this.z=t}get height(){return this.w}set height(t){this.w=t}set(t,e,n,s){return this.x=t,this.y=e,this.z=n,this.w=s,this}setScalar(t){return this.x=t,this.y=t,this.z=t,this.w=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setZ(t){return this.z=t,this}setW(t){return this.w=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;case 2:this.z=e;break;case 3:this.w=e;break;default:throw new Error("THREE.Vector4: index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(t){return this.x=t.x,this.y=t.y,this.z=t.z,this.w=t.w!==void 0?t.w:1,this}add(t){return this.x+=t.x,this.y+=t.y,this.z+=t.z,this.w+=t.w,this}addScalar(t){return this.x+=t,this.y+=t,this.z+=t,this.w+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this.z=t.z+e.z,this.w=t.w+e.w,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this.z+=t.z*e,this.w+=t.w*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this.z-=t.z,this.w-=t.w,this}subScalar(t){return this.x-=t,this.y-=t,this.z-=t,this.w-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this.z=t.z-e.z,this.w=t.w-e.w,this}multiply(t){return this.x*=t.x,this.y*=t.y,this.z*=t.z,this.w*=t.w,this}multiplyScalar(t){return this.x*=t,this.y*=t,this.z*=t,this.w*=t,this}applyMatrix4(t){let e=this.x,n=this.y,s=this.z,r=this.w,o=t.elements;return this.x=o[0]*e+o[4]*n+o[8]*s+o[12]*r,this.y=o[1]*e+o[5]*n+o[9]*s+o[13]*r,this.z=o[2]*e+o[6]*n+o[10]*s+o[14]*r,this.w=o[3]*e+o[7]*n+o[11]*s+o[15]*r,this}divide(t){return this.x/=t.x,this.y/=t.y,this.z/=t.z,this.w/=t.w,this}divideScalar(t){return this.multiplyScalar(1/t)}setAxisAngleFromQuaternion(t){this.w=2*Math.acos(t.w);let e=Math.sqrt(1-t.w*t.w);return e<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=t.x/e,this.y=t.y/e,this.z=t.z/e),this}setAxisAngleFromRotationMatrix(t){let e,n,s,r,l=t.elements,c=l[0],d=l[4],h=l[8],u=l[1],f=l[5],p=l[9],_=l[2],m=l[6],g=l[10];if(Math.abs(d-u)<.01&&Math.abs(h-_)<.01&&Math.abs(p-m)<.01){if(Math.abs(d+u)<.1&&Math.abs(h+_)<.1&&Math.abs(p+m)<.1&&Math.abs(c+f+g-3)<.1)return this.set(1,0,0,0),this;e=Math.PI;let T=(c+1)/2,v=(f+1)/2,M=(g+1)/2,b=(d+u)/4,x=(h+_)/4,w=(p+m)/4;return T>v&&T>M?T<.01?(n=0,s=.707106781,r=.707106781):(n=Math.sqrt(T),s=b/n,r=x/n):v>M?v<.01?(n=.707106781,s=0,r=.707106781):(s=Math.sqrt(v),n=b/s,r=w/s):M<.01?(n=.707106781,s=.707106781,r=0):(r=Math.sqrt(M),n=x/r,s=w/r),this.set(n,s,r,e),this}let y=Math.sqrt((m-p)*(m-p)+(h-_)*(h-_)+(u-d)*(u-d));return Math.abs(y)<.001&&(y=1),this.x=(m-p)/y,this.y=(h-_)/y,this.z=(u-d)/y,this.w=Math.acos((c+f+g-1)/2),this}setFromMatrixPosition(t){let e=t.elements;return this.x=e[12],this.y=e[13],this.z=e[14],this.w=e[15],this}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this.z=Math.min(this.z,t.z),this.w=Math.min(this.w,t.w),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this.z=Math.max(this.z,t.z),this.w=Math.max(this.w,t.w),this}clamp(t,e){return this.x=he(this.x,t.x,e.x),this.y=he(this.y,t.y,e.y),this.z=he(this.z,t.z,e.z),this.w=he(this.w,t.w,e.w),this}clampScalar(t,e){return this.x=he(this.x,t,e),this.y=he(this.y,t,e),this.z=he(this.z,t,e),this.w=he(this.w,t,e),this}clampLength(t,e){let n=this.length();return this.divideScalar(n||1).multiplyScalar(he(n,t,e))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(t){return this.x*t.x+this.y*t.y+this.z*t.z+this.w*t.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this.z+=(t.z-this.z)*e,this.w+=(t.w-this.w)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this.z=t.z+(e.z-t.z)*n,this.w=t.w+(e.w-t.w)*n,this}equals(t){return t.x===this.x&&t.y===this.y&&t.z===this.z&&t.w===this.w}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this.z=t[e+2],this.w=t[e+3],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t[e+2]=this.z,t[e+3]=this.w,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this.z=t.getZ(e),this.w=t.getW(e),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},Ac=class extends $i{constructor(t=1,e=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:ci,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=t,this.height=e,this.depth=n.depth,this.scissor=new De(0,0,t,e),this.scissorTest=!1,this.viewport=new De(0,0,t,e),this.textures=[];let s=n.count;for(let r=0;r<s;r++)this.textures[r]=new Wn({width:t,height:e,depth:n.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(t={}){let e={minFilter:ci,generateMipmaps:!1,flipY:!1,internalFormat:null};t.mapping!==void 0&&(e.mapping=t.mapping),t.wrapS!==void 0&&(e.wrapS=t.wrapS),t.wrapT!==void 0&&(e.wrapT=t.wrapT),t.wrapR!==void 0&&(e.wrapR=t.wrapR),t.magFilter!==void 0&&(e.magFilter=t.magFilter),t.minFilter!==void 0&&(e.minFilter=t.minFilter),t.format!==void 0&&(e.format=t.format),t.type!==void 0&&(e.type=t.type),t.anisotropy!==void 0&&(e.anisotropy=t.anisotropy),t.colorSpace!==void 0&&(e.colorSpace=t.colorSpace),t.flipY!==void 0&&(e.flipY=t.flipY),t.generateMipmaps!==void 0&&(e.generateMipmaps=t.generateMipmaps),t.mipmapsAutoUpdate!==void 0&&(e.mipmapsAutoUpdate=t.mipmapsAutoUpdate),t.internalFormat!==void 0&&(e.internalFormat=t.internalFormat);for(let n=0;n<this.textures.length;n++)this.textures[n].setValues(e)}get texture(){return this.textures[0]}set texture(t){this.textures[0]=t}set depthTexture(t){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),t!==null&&t.renderTarget===null&&(t.renderTarget=this),this._depthTexture=t}get depthTexture(){return this._depthTexture}setSize(t,e,n=1){if(this.width!==t||this.height!==e||this.depth!==n){this.width=t,this.height=e,this.depth=n;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=t,this.textures[s].image.height=e,this.textures[s].image.depth=n,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,t,e),this.scissor.set(0,0,t,e)}clone(){return new this.constructor().copy(this)}copy(t){this.width=t.width,this.height=t.height,this.depth=t.depth,this.scissor.copy(t.scissor),this.scissorTest=t.scissorTest,this.viewport.copy(t.viewport),this.textures.length=0;for(let e=0,n=t.textures.length;e<n;e++){this.textures[e]=t.textures[e].clone(),this.textures[e].isRenderTargetTexture=!0,this.textures[e].renderTarget=this;let s=Object.assign({},t.textures[e].image);this.textures[e].source=new Io(s)}if(this.depthBuffer=t.depthBuffer,this.stencilBuffer=t.stencilBuffer,this.resolveColorBuffer=t.resolveColorBuffer,this.resolveDepthBuffer=t.resolveDepthBuffer,this.resolveStencilBuffer=t.resolveStencilBuffer,this.storeMultisampledColorBuffer=t.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=t.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=t.storeMultisampledStencilBuffer,t.depthTexture!==null)if(t.depthTexture.renderTarget===t){let e=t.depthTexture.clone();e.renderTarget=null,this.depthTexture=e}else this.depthTexture=t.depthTexture;else this.depthTexture=null;return this.samples=t.samples,this.multiview=t.multiview,this.useArrayDepthTexture=t.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},Xn=class extends Ac{constructor(t=1,e=1,n={}){super(t,e,n),this.isWebGLRenderTarget=!0}},Oa=class extends Wn{constructor(t=null,e=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:t,width:e,height:n,depth:s},this.magFilter=zn,this.minFilter=zn,this.wrapR=hs,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(t){return super.copy(t),this.wrapR=t.wrapR,this}addLayerUpdate(t){this.layerUpdates.add(t)}clearLayerUpdates(){this.layerUpdates.clear()}};var Cc=class extends Wn{constructor(t=null,e=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:t,width:e,height:n,depth:s},this.magFilter=zn,this.minFilter=zn,this.wrapR=hs,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(t){return super.copy(t),this.wrapR=t.wrapR,this}};var Wt=class i{static{this.prototype.isMatrix4=!0}constructor(t,e,n,s,r,o,a,l,c,d,h,u,f,p,_,m){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],t!==void 0&&this.set(t,e,n,s,r,o,a,l,c,d,h,u,f,p,_,m)}set(t,e,n,s,r,o,a,l,c,d,h,u,f,p,_,m){let g=this.elements;return g[0]=t,g[4]=e,g[8]=n,g[12]=s,g[1]=r,g[5]=o,g[9]=a,g[13]=l,g[2]=c,g[6]=d,g[10]=h,g[14]=u,g[3]=f,g[7]=p,g[11]=_,g[15]=m,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new i().fromArray(this.elements)}copy(t){let e=this.elements,n=t.elements;return e[0]=n[0],e[1]=n[1],e[2]=n[2],e[3]=n[3],e[4]=n[4],e[5]=n[5],e[6]=n[6],e[7]=n[7],e[8]=n[8],e[9]=n[9],e[10]=n[10],e[11]=n[11],e[12]=n[12],e[13]=n[13],e[14]=n[14],e[15]=n[15],this}copyPosition(t){let e=this.elements,n=t.elements;return e[12]=n[12],e[13]=n[13],e[14]=n[14],this}setFromMatrix3(t){let e=t.elements;return this.set(e[0],e[3],e[6],0,e[1],e[4],e[7],0,e[2],e[5],e[8],0,0,0,0,1),this}extractBasis(t,e,n){return this.determinantAffine()===0?(t.set(1,0,0),e.set(0,1,0),n.set(0,0,1),this):(t.setFromMatrixColumn(this,0),e.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(t,e,n){return this.set(t.x,e.x,n.x,0,t.y,e.y,n.y,0,t.z,e.z,n.z,0,0,0,0,1),this}extractRotation(t){if(t.determinantAffine()===0)return this.identity();let e=this.elements,n=t.elements,s=1/oo.setFromMatrixColumn(t,0).length(),r=1/oo.setFromMatrixColumn(t,1).length(),o=1/oo.setFromMatrixColumn(t,2).length();return e[0]=n[0]*s,e[1]=n[1]*s,e[2]=n[2]*s,e[3]=0,e[4]=n[4]*r,e[5]=n[5]*r,e[6]=n[6]*r,e[7]=0,e[8]=n[8]*o,e[9]=n[9]*o,e[10]=n[10]*o,e[11]=0,e[12]=0,e[13]=0,e[14]=0,e[15]=1,this}makeRotationFromEuler(t){let e=this.elements,n=t.x,s=t.y,r=t.z,o=Math.cos(n),a=Math.sin(n),l=Math.cos(s),c=Math.sin(s),d=Math.cos(r),h=Math.sin(r);if(t.order==="XYZ"){let u=o*d,f=o*h,p=a*d,_=a*h;e[0]=l*d,e[4]=-l*h,e[8]=c,e[1]=f+p*c,e[5]=u-_*c,e[9]=-a*l,e[2]=_-u*c,e[6]=p+f*c,e[10]=o*l}else if(t.order==="YXZ"){let u=l*d,f=l*h,p=c*d,_=c*h;e[0]=u+_*a,e[4]=p*a-f,e[8]=o*c,e[1]=o*h,e[5]=o*d,e[9]=-a,e[2]=f*a-p,e[6]=_+u*a,e[10]=o*l}else if(t.order==="ZXY"){let u=l*d,f=l*h,p=c*d,_=c*h;e[0]=u-_*a,e[4]=-o*h,e[8]=p+f*a,e[1]=f+p*a,e[5]=o*d,e[9]=_-u*a,e[2]=-o*c,e[6]=a,e[10]=o*l}else if(t.order==="ZYX"){let u=o*d,f=o*h,p=a*d,_=a*h;e[0]=l*d,e[4]=p*c-f,e[8]=u*c+_,e[1]=l*h,e[5]=_*c+u,e[9]=f*c-p,e[2]=-c,e[6]=a*l,e[10]=o*l}else if(t.order==="YZX"){let u=o*l,f=o*c,p=a*l,_=a*c;e[0]=l*d,e[4]=_-u*h,e[8]=p*h+f,e[1]=h,e[5]=o*d,e[9]=-a*d,e[2]=-c*d,e[6]=f*h+p,e[10]=u-_*h}else if(t.order==="XZY"){let u=o*l,f=o*c,p=a*l,_=a*c;e[0]=l*d,e[4]=-h,e[8]=c*d,e[1]=u*h+_,e[5]=o*d,e[9]=f*h-p,e[2]=p*h-f,e[6]=a*d,e[10]=_*h+u}return e[3]=0,e[7]=0,e[11]=0,e[12]=0,e[13]=0,e[14]=0,e[15]=1,this}makeRotationFromQuaternion(t){return this.compose(wy,t,by)}lookAt(t,e,n){let s=this.elements;return bi.subVectors(t,e),bi.lengthSq()===0&&(bi.z=1),bi.normalize(),js.crossVectors(n,bi),js.lengthSq()===0&&(Math.abs(n.z)===1?bi.x+=1e-4:bi.z+=1e-4,bi.normalize(),js.crossVectors(n,bi)),js.normalize(),kl.crossVectors(bi,js),s[0]=js.x,s[4]=kl.x,s[8]=bi.x,s[1]=js.y,s[5]=kl.y,s[9]=bi.y,s[2]=js.z,s[6]=kl.z,s[10]=bi.z,this}multiply(t){return this.multiplyMatrices(this,t)}premultiply(t){return this.multiplyMatrices(t,this)}multiplyMatrices(t,e){let n=t.elements,s=e.elements,r=this.elements,o=n[0],a=n[4],l=n[8],c=n[12],d=n[1],h=n[5],u=n[9],f=n[13],p=n[2],_=n[6],m=n[10],g=n[14],y=n[3],T=n[7],v=n[11],M=n[15],b=s[0],x=s[4],w=s[8],O=s[12],P=s[1],L=s[5],B=s[9],G=s[13],D=s[2],X=s[6],Z=s[10],W=s[14],at=s[3],k=s[7],q=s[11],Q=s[15];return r[0]=o*b+a*P+l*D+c*at,r[4]=o*x+a*L+l*X+c*k,r[8]=o*w+a*B+l*Z+c*q,r[12]=o*O+a*G+l*W+c*Q,r[1]=d*b+h*P+u*D+f*at,r[5]=d*x+h*L+u*X+f*k,r[9]=d*w+h*B+u*Z+f*q,r[13]=d*O+h*G+u*W+f*Q,r[2]=p*b+_*P+m*D+g*at,r[6]=p*x+_*L+m*X+g*k,r[10]=p*w+_*B+m*Z+g*q,r[14]=p*O+_*G+m*W+g*Q,r[3]=y*b+T*P+v*D+M*at,r[7]=y*x+T*L+v*X+M*k,r[11]=y*w+T*B+v*Z+M*q,r[15]=y*O+T*G+v*W+M*Q,this}multiplyScalar(t){let e=this.elements;return e[0]*=t,e[4]*=t,e[8]*=t,e[12]*=t,e[1]*=t,e[5]*=t,e[9]*=t,e[13]*=t,e[2]*=t,e[6]*=t,e[10]*=t,e[14]*=t,e[3]*=t,e[7]*=t,e[11]*=t,e[15]*=t,this}determinant(){let t=this.elements,e=t[0],n=t[4],s=t[8],r=t[12],o=t[1],a=t[5],l=t[9],c=t[13],d=t[2],h=t[6],u=t[10],f=t[14],p=t[3],_=t[7],m=t[11],g=t[15],y=l*f-c*u,T=a*f-c*h,v=a*u-l*h,M=o*f-c*d,b=o*u-l*d,x=o*h-a*d;return e*(_*y-m*T+g*v)-n*(p*y-m*M+g*b)+s*(p*T-_*M+g*x)-r*(p*v-_*b+m*x)}determinantAffine(){let t=this.elements,e=t[0],n=t[4],s=t[8],r=t[1],o=t[5],a=t[9],l=t[2],c=t[6],d=t[10];return e*(o*d-a*c)-n*(r*d-a*l)+s*(r*c-o*l)}transpose(){let t=this.elements,e;return e=t[1],t[1]=t[4],t[4]=e,e=t[2],t[2]=t[8],t[8]=e,e=t[6],t[6]=t[9],t[9]=e,e=t[3],t[3]=t[12],t[12]=e,e=t[7],t[7]=t[13],t[13]=e,e=t[11],t[11]=t[14],t[14]=e,this}setPosition(t,e,n){let s=this.elements;return t.isVector3?(s[12]=t.x,s[13]=t.y,s[14]=t.z):(s[12]=t,s[13]=e,s[14]=n),this}invert(){let t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],o=t[4],a=t[5],l=t[6],c=t[7],d=t[8],h=t[9],u=t[10],f=t[11],p=t[12],_=t[13],m=t[14],g=t[15],y=e*a-n*o,T=e*l-s*o,v=e*c-r*o,M=n*l-s*a,b=n*c-r*a,x=s*c-r*l,w=d*_-h*p,O=d*m-u*p,P=d*g-f*p,L=h*m-u*_,B=h*g-f*_,G=u*g-f*m,D=y*G-T*B+v*L+M*P-b*O+x*w;if(D===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let X=1/D;return t[0]=(a*G-l*B+c*L)*X,t[1]=(s*B-n*G-r*L)*X,t[2]=(_*x-m*b+g*M)*X,t[3]=(u*b-h*x-f*M)*X,t[4]=(l*P-o*G-c*O)*X,t[5]=(e*G-s*P+r*O)*X,t[6]=(m*v-p*x-g*T)*X,t[7]=(d*x-u*v+f*T)*X,t[8]=(o*B-a*P+c*w)*X,t[9]=(n*P-e*B-r*w)*X,t[10]=(p*b-_*v+g*y)*X,t[11]=(h*v-d*b-f*y)*X,t[12]=(a*O-o*L-l*w)*X,t[13]=(e*L-n*O+s*w)*X,t[14]=(_*T-p*M-m*y)*X,t[15]=(d*M-h*T+u*y)*X,this}scale(t){let e=this.elements,n=t.x,s=t.y,r=t.z;return e[0]*=n,e[4]*=s,e[8]*=r,e[1]*=n,e[5]*=s,e[9]*=r,e[2]*=n,e[6]*=s,e[10]*=r,e[3]*=n,e[7]*=s,e[11]*=r,this}getMaxScaleOnAxis(){let t=this.elements,e=t[0]*t[0]+t[1]*t[1]+t[2]*t[2],n=t[4]*t[4]+t[5]*t[5]+t[6]*t[6],s=t[8]*t[8]+t[9]*t[9]+t[10]*t[10];return Math.sqrt(Math.max(e,n,s))}makeTranslation(t,e,n){return t.isVector3?this.set(1,0,0,t.x,0,1,0,t.y,0,0,1,t.z,0,0,0,1):this.set(1,0,0,t,0,1,0,e,0,0,1,n,0,0,0,1),this}makeRotationX(t){let e=Math.cos(t),n=Math.sin(t);return this.set(1,0,0,0,0,e,-n,0,0,n,e,0,0,0,0,1),this}makeRotationY(t){let e=Math.cos(t),n=Math.sin(t);return this.set(e,0,n,0,0,1,0,0,-n,0,e,0,0,0,0,1),this}makeRotationZ(t){let e=Math.cos(t),n=Math.sin(t);return this.set(e,-n,0,0,n,e,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(t,e){let n=Math.cos(e),s=Math.sin(e),r=1-n,o=t.x,a=t.y,l=t.z,c=r*o,d=r*a;return this.set(c*o+n,c*a-s*l,c*l+s*a,0,c*a+s*l,d*a+n,d*l-s*o,0,c*l-s*a,d*l+s*o,r*l*l+n,0,0,0,0,1),this}makeScale(t,e,n){return this.set(t,0,0,0,0,e,0,0,0,0,n,0,0,0,0,1),this}makeShear(t,e,n,s,r,o){return this.set(1,n,r,0,t,1,o,0,e,s,1,0,0,0,0,1),this}compose(t,e,n){let s=this.elements,r=e._x,o=e._y,a=e._z,l=e._w,c=r+r,d=o+o,h=a+a,u=r*c,f=r*d,p=r*h,_=o*d,m=o*h,g=a*h,y=l*c,T=l*d,v=l*h,M=n.x,b=n.y,x=n.z;return s[0]=(1-(_+g))*M,s[1]=(f+v)*M,s[2]=(p-T)*M,s[3]=0,s[4]=(f-v)*b,s[5]=(1-(u+g))*b,s[6]=(m+y)*b,s[7]=0,s[8]=(p+T)*x,s[9]=(m-y)*x,s[10]=(1-(u+_))*x,s[11]=0,s[12]=t.x,s[13]=t.y,s[14]=t.z,s[15]=1,this}decompose(t,e,n){let s=this.elements;t.x=s[12],t.y=s[13],t.z=s[14];let r=this.determinantAffine();if(r===0)return n.set(1,1,1),e.identity(),this;let o=oo.set(s[0],s[1],s[2]).length(),a=oo.set(s[4],s[5],s[6]).length(),l=oo.set(s[8],s[9],s[10]).length();r<0&&(o=-o),Xi.copy(this);let c=1/o,d=1/a,h=1/l;return Xi.elements[0]*=c,Xi.elements[1]*=c,Xi.elements[2]*=c,Xi.elements[4]*=d,Xi.elements[5]*=d,Xi.elements[6]*=d,Xi.elements[8]*=h,Xi.elements[9]*=h,Xi.elements[10]*=h,e.setFromRotationMatrix(Xi),n.x=o,n.y=a,n.z=l,this}makePerspective(t,e,n,s,r,o,a=Oi,l=!1){let c=this.elements,d=2*r/(e-t),h=2*r/(n-s),u=(e+t)/(e-t),f=(n+s)/(n-s),p,_;if(l)p=r/(o-r),_=o*r/(o-r);else if(a===Oi)p=-(o+r)/(o-r),_=-2*o*r/(o-r);else if(a===Ro)p=-o/(o-r),_=-o*r/(o-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+a);return c[0]=d,c[4]=0,c[8]=u,c[12]=0,c[1]=0,c[5]=h,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=p,c[14]=_,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(t,e,n,s,r,o,a=Oi,l=!1){let c=this.elements,d=2/(e-t),h=2/(n-s),u=-(e+t)/(e-t),f=-(n+s)/(n-s),p,_;if(l)p=1/(o-r),_=o/(o-r);else if(a===Oi)p=-2/(o-r),_=-(o+r)/(o-r);else if(a===Ro)p=-1/(o-r),_=-r/(o-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+a);return c[0]=d,c[4]=0,c[8]=0,c[12]=u,c[1]=0,c[5]=h,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=p,c[14]=_,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(t){let e=this.elements,n=t.elements;for(let s=0;s<16;s++)if(e[s]!==n[s])return!1;return!0}fromArray(t,e=0){for(let n=0;n<16;n++)this.elements[n]=t[n+e];return this}toArray(t=[],e=0){let n=this.elements;return t[e]=n[0],t[e+1]=n[1],t[e+2]=n[2],t[e+3]=n[3],t[e+4]=n[4],t[e+5]=n[5],t[e+6]=n[6],t[e+7]=n[7],t[e+8]=n[8],t[e+9]=n[9],t[e+10]=n[10],t[e+11]=n[11],t[e+12]=n[12],t[e+13]=n[13],t[e+14]=n[14],t[e+15]=n[15],t}},oo=new R,Xi=new Wt,wy=new R(0,0,0),by=new R(1,1,1),js=new R,kl=new R,bi=new R,Qp=new Wt,tm=new ze,Qn=class i{constructor(t=0,e=0,n=0,s=i.DEFAULT_ORDER){this.isEuler=!0,this._x=t,this._y=e,this._z=n,this._order=s}get x(){return this._x}set x(t){this._x=t,this._onChangeCallback()}get y(){return this._y}set y(t){this._y=t,this._onChangeCallback()}get z(){return this._z}set z(t){this._z=t,this._onChangeCallback()}get order(){return this._order}set order(t){this._order=t,this._onChangeCallback()}set(t,e,n,s=this._order){return this._x=t,this._y=e,this._z=n,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(t){return this._x=t._x,this._y=t._y,this._z=t._z,this._order=t._order,this._onChangeCallback(),this}setFromRotationMatrix(t,e=this._order,n=!0){let s=t.elements,r=s[0],o=s[4],a=s[8],l=s[1],c=s[5],d=s[9],h=s[2],u=s[6],f=s[10];switch(e){case"XYZ":this._y=Math.asin(he(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(-d,f),this._z=Math.atan2(-o,r)):(this._x=Math.atan2(u,c),this._z=0);break;case"YXZ":this._x=Math.asin(-he(d,-1,1)),Math.abs(d)<.9999999?(this._y=Math.atan2(a,f),this._z=Math.atan2(l,c)):(this._y=Math.atan2(-h,r),this._z=0);break;case"ZXY":this._x=Math.asin(he(u,-1,1)),Math.abs(u)<.9999999?(this._y=Math.atan2(-h,f),this._z=Math.atan2(-o,c)):(this._y=0,this._z=Math.atan2(l,r));break;case"ZYX":this._y=Math.asin(-he(h,-1,1)),Math.abs(h)<.9999999?(this._x=Math.atan2(u,f),this._z=Math.atan2(l,r)):(this._x=0,this._z=Math.atan2(-o,c));break;case"YZX":this._z=Math.asin(he(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-d,c),this._y=Math.atan2(-h,r)):(this._x=0,this._y=Math.atan2(a,f));break;case"XZY":this._z=Math.asin(-he(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(u,c),this._y=Math.atan2(a,r)):(this._x=Math.atan2(-d,f),this._y=0);break;default:jt("Euler: .setFromRotationMatrix() encountered an unknown order: "+e)}return this._order=e,n===!0&&this._onChangeCallback(),this}setFromQuaternion(t,e,n){return Qp.makeRotationFromQuaternion(t),this.setFromRotationMatrix(Qp,e,n)}setFromVector3(t,e=this._order){return this.set(t.x,t.y,t.z,e)}reorder(t){return tm.setFromEuler(this),this.setFromQuaternion(tm,t)}equals(t){return t._x===this._x&&t._y===this._y&&t._z===this._z&&t._order===this._order}fromArray(t){return this._x=t[0],this._y=t[1],this._z=t[2],t[3]!==void 0&&(this._order=t[3]),this._onChangeCallback(),this}toArray(t=[],e=0){return t[e]=this._x,t[e+1]=this._y,t[e+2]=this._z,t[e+3]=this._order,t}_onChange(t){return this._onChangeCallback=t,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};Qn.DEFAULT_ORDER="XYZ";var Lo=class{constructor(){this.mask=1}set(t){this.mask=(1<<t|0)>>>0}enable(t){this.mask|=1<<t|0}enableAll(){this.mask=-1}toggle(t){this.mask^=1<<t|0}disable(t){this.mask&=~(1<<t|0)}disableAll(){this.mask=0}test(t){return(this.mask&t.mask)!==0}isEnabled(t){return(this.mask&(1<<t|0))!==0}},Ty=0,em=new R,ao=new ze,Es=new Wt,zl=new R,_a=new R,Ey=new R,Ay=new ze,nm=new R(1,0,0),im=new R(0,1,0),sm=new R(0,0,1),rm={type:"added"},Cy={type:"removed"},lo={type:"childadded",child:null},Ku={type:"childremoved",child:null},Ee=class i extends $i{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Ty++}),this.uuid=pr(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=i.DEFAULT_UP.clone();let t=new R,e=new Qn,n=new ze,s=new R(1,1,1);function r(){n.setFromEuler(e,!1)}function o(){e.setFromQuaternion(n,void 0,!1)}e._onChange(r),n._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:t},rotation:{configurable:!0,enumerable:!0,value:e},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new Wt},normalMatrix:{value:new re}}),this.matrix=new Wt,this.matrixWorld=new Wt,this.matrixAutoUpdate=i.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=i.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Lo,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(t){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(t),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(t){return this.quaternion.premultiply(t),this}setRotationFromAxisAngle(t,e){this.quaternion.setFromAxisAngle(t,e)}setRotationFromEuler(t){this.quaternion.setFromEuler(t,!0)}setRotationFromMatrix(t){this.quaternion.setFromRotationMatrix(t)}setRotationFromQuaternion(t){this.quaternion.copy(t)}rotateOnAxis(t,e){return ao.setFromAxisAngle(t,e),this.quaternion.multiply(ao),this}rotateOnWorldAxis(t,e){return ao.setFromAxisAngle(t,e),this.quaternion.premultiply(ao),this}rotateX(t){return this.rotateOnAxis(nm,t)}rotateY(t){return this.rotateOnAxis(im,t)}rotateZ(t){return this.rotateOnAxis(sm,t)}translateOnAxis(t,e){return em.copy(t).applyQuaternion(this.quaternion),this.position.add(em.multiplyScalar(e)),this}translateX(t){return this.translateOnAxis(nm,t)}translateY(t){return this.translateOnAxis(im,t)}translateZ(t){return this.translateOnAxis(sm,t)}localToWorld(t){return this.updateWorldMatrix(!0,!1),t.applyMatrix4(this.matrixWorld)}worldToLocal(t){return this.updateWorldMatrix(!0,!1),t.applyMatrix4(Es.copy(this.matrixWorld).invert())}lookAt(t,e,n){t.isVector3?zl.copy(t):zl.set(t,e,n);let s=this.parent;this.updateWorldMatrix(!0,!1),_a.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?Es.lookAt(_a,zl,this.up):Es.lookAt(zl,_a,this.up),this.quaternion.setFromRotationMatrix(Es),s&&(Es.extractRotation(s.matrixWorld),ao.setFromRotationMatrix(Es),this.quaternion.premultiply(ao.invert()))}add(t){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.add(arguments[e]);return this}return t===this?(te("Object3D.add: object can't be added as a child of itself.",t),this):(t&&t.isObject3D?(t.removeFromParent(),t.parent=this,this.children.push(t),t.dispatchEvent(rm),lo.child=t,this.dispatchEvent(lo),lo.child=null):te("Object3D.add: object not an instance of THREE.Object3D.",t),this)}remove(t){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}let e=this.children.indexOf(t);return e!==-1&&(t.parent=null,this.children.splice(e,1),t.dispatchEvent(Cy),Ku.child=t,this.dispatchEvent(Ku),Ku.child=null),this}removeFromParent(){let t=this.parent;return t!==null&&t.remove(this),this}clear(){return this.remove(...this.children)}attach(t){return this.updateWorldMatrix(!0,!1),Es.copy(this.matrixWorld).invert(),t.parent!==null&&(t.parent.updateWorldMatrix(!0,!1),Es.multiply(t.parent.matrixWorld)),t.applyMatrix4(Es),t.removeFromParent(),t.parent=this,this.children.push(t),t.updateWorldMatrix(!1,!0),t.dispatchEvent(rm),lo.child=t,this.dispatchEvent(lo),lo.child=null,this}getObjectById(t){return this.getObjectByProperty("id",t)}getObjectByName(t){return this.getObjectByProperty("name",t)}getObjectByProperty(t,e){if(this[t]===e)return this;for(let n=0,s=this.children.length;n<s;n++){let o=this.children[n].getObjectByProperty(t,e);if(o!==void 0)return o}}getObjectsByProperty(t,e,n=[]){this[t]===e&&n.push(this);let s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].getObjectsByProperty(t,e,n);return n}getWorldPosition(t){return this.updateWorldMatrix(!0,!1),t.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(t){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(_a,t,Ey),t}getWorldScale(t){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(_a,Ay,t),t}getWorldDirection(t){this.updateWorldMatrix(!0,!1);let e=this.matrixWorld.elements;return t.set(e[8],e[9],e[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(t){t(this);let e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].traverse(t)}traverseVisible(t){if(this.visible===!1)return;t(this);let e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].traverseVisible(t)}traverseAncestors(t){let e=this.parent;e!==null&&(t(e),e.traverseAncestors(t))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let t=this.pivot;if(t!==null){let e=t.x,n=t.y,s=t.z,r=this.matrix.elements;r[12]+=e-r[0]*e-r[4]*n-r[8]*s,r[13]+=n-r[1]*e-r[5]*n-r[9]*s,r[14]+=s-r[2]*e-r[6]*n-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(t){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||t)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,t=!0);let e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].updateMatrixWorld(t)}updateWorldMatrix(t,e,n=!1){let s=this.parent;if(t===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),e===!0){let r=this.children;for(let o=0,a=r.length;o<a;o++)r[o].updateWorldMatrix(!1,!0,n)}}toJSON(t){let e=t===void 0||typeof t=="string",n={};e&&(t={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(a=>({...a,boundingBox:a.boundingBox?a.boundingBox.toJSON():void 0,boundingSphere:a.boundingSphere?a.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(a=>({...a})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(t),s.indirectTexture=this._indirectTexture.toJSON(t),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(t)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(a,l){return a[l.uuid]===void 0&&(a[l.uuid]=l.toJSON(t)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(t).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(t).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(t.geometries,this.geometry);let a=this.geometry.parameters;if(a!==void 0&&a.shapes!==void 0){let l=a.shapes;if(Array.isArray(l))for(let c=0,d=l.length;c<d;c++){let h=l[c];r(t.shapes,h)}else r(t.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(t.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let a=[];for(let l=0,c=this.material.length;l<c;l++)a.push(r(t.materials,this.material[l]));s.material=a}else s.material=r(t.materials,this.material);if(this.children.length>0){s.children=[];for(let a=0;a<this.children.length;a++)s.children.push(this.children[a].toJSON(t).object)}if(this.animations.length>0){s.animations=[];for(let a=0;a<this.animations.length;a++){let l=this.animations[a];s.animations.push(r(t.animations,l))}}if(e){let a=o(t.geometries),l=o(t.materials),c=o(t.textures),d=o(t.images),h=o(t.shapes),u=o(t.skeletons),f=o(t.animations),p=o(t.nodes);a.length>0&&(n.geometries=a),l.length>0&&(n.materials=l),c.length>0&&(n.textures=c),d.length>0&&(n.images=d),h.length>0&&(n.shapes=h),u.length>0&&(n.skeletons=u),f.length>0&&(n.animations=f),p.length>0&&(n.nodes=p)}return n.object=s,n;function o(a){let l=[];for(let c in a){let d=a[c];delete d.metadata,l.push(d)}return l}}clone(t){return new this.constructor().copy(this,t)}copy(t,e=!0){if(this.name=t.name,this.up.copy(t.up),this.position.copy(t.position),this.rotation.order=t.rotation.order,this.quaternion.copy(t.quaternion),this.scale.copy(t.scale),this.pivot=t.pivot!==null?t.pivot.clone():null,this.matrix.copy(t.matrix),this.matrixWorld.copy(t.matrixWorld),this.matrixAutoUpdate=t.matrixAutoUpdate,this.matrixWorldAutoUpdate=t.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=t.matrixWorldNeedsUpdate,this.layers.mask=t.layers.mask,this.visible=t.visible,this.castShadow=t.castShadow,this.receiveShadow=t.receiveShadow,this.frustumCulled=t.frustumCulled,this.renderOrder=t.renderOrder,this.static=t.static,this.animations=t.animations.slice(),this.userData=JSON.parse(JSON.stringify(t.userData)),e===!0)for(let n=0;n<t.children.length;n++){let s=t.children[n];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};Ee.DEFAULT_UP=new R(0,1,0);Ee.DEFAULT_MATRIX_AUTO_UPDATE=!0;Ee.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var Cn=class extends Ee{constructor(){super(),this.isGroup=!0,this.type="Group"}},Ry={type:"move"},Do=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new Cn,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new Cn,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new R,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new R),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new Cn,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new R,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new R,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(t){return this._targetRay!==null&&this._targetRay.dispatchEvent(t),this._grip!==null&&this._grip.dispatchEvent(t),this._hand!==null&&this._hand.dispatchEvent(t),this}connect(t){if(t&&t.hand){let e=this._hand;if(e)for(let n of t.hand.values())this._getHandJoint(e,n)}return this.dispatchEvent({type:"connected",data:t}),this}disconnect(t){return this.dispatchEvent({type:"disconnected",data:t}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(t,e,n){let s=null,r=null,o=null,a=this._targetRay,l=this._grip,c=this._hand;if(t&&e.session.visibilityState!=="visible-blurred"){if(c&&t.hand){o=!0;for(let _ of t.hand.values()){let m=e.getJointPose(_,n),g=this._getHandJoint(c,_);m!==null&&(g.matrix.fromArray(m.transform.matrix),g.matrix.decompose(g.position,g.quaternion,g.scale),g.matrixWorldNeedsUpdate=!0,g.jointRadius=m.radius),g.visible=m!==null}let d=c.joints["index-finger-tip"],h=c.joints["thumb-tip"],u=d.position.distanceTo(h.position),f=.02,p=.005;c.inputState.pinching&&u>f+p?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:t.handedness,target:this})):!c.inputState.pinching&&u<=f-p&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:t.handedness,target:this}))}else l!==null&&t.gripSpace&&(r=e.getPose(t.gripSpace,n),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.quaternion,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1,l.eventsEnabled&&l.dispatchEvent({type:"gripUpdated",data:t,target:this})));a!==null&&(s=e.getPose(t.targetRaySpace,n),s===null&&r!==null&&(s=r),s!==null&&(a.matrix.fromArray(s.transform.matrix),a.matrix.decompose(a.position,a.quaternion,a.scale),a.matrixWorldNeedsUpdate=!0,s.linearVelocity?(a.hasLinearVelocity=!0,a.linearVelocity.copy(s.linearVelocity)):a.hasLinearVelocity=!1,s.angularVelocity?(a.hasAngularVelocity=!0,a.angularVelocity.copy(s.angularVelocity)):a.hasAngularVelocity=!1,this.dispatchEvent(Ry)))}return a!==null&&(a.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=o!==null),this}_getHandJoint(t,e){if(t.joints[e.jointName]===void 0){let n=new Cn;n.matrixAutoUpdate=!1,n.visible=!1,t.joints[e.jointName]=n,t.add(n)}return t.joints[e.jointName]}},gg={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},Ks={h:0,s:0,l:0},Vl={h:0,s:0,l:0};function Qu(i,t,e){return e<0&&(e+=1),e>1&&(e-=1),e<1/6?i+(t-i)*6*e:e<1/2?t:e<2/3?i+(t-i)*6*(2/3-e):i}var Xt=class{constructor(t,e,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(t,e,n)}set(t,e,n){if(e===void 0&&n===void 0){let s=t;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(t,e,n);return this}setScalar(t){return this.r=t,this.g=t,this.b=t,this}setHex(t,e=Te){return t=Math.floor(t),this.r=(t>>16&255)/255,this.g=(t>>8&255)/255,this.b=(t&255)/255,Se.colorSpaceToWorking(this,e),this}setRGB(t,e,n,s=Se.workingColorSpace){return this.r=t,this.g=e,this.b=n,Se.colorSpaceToWorking(this,s),this}setHSL(t,e,n,s=Se.workingColorSpace){if(t=tf(t,1),e=he(e,0,1),n=he(n,0,1),e===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+e):n+e-n*e,o=2*n-r;this.r=Qu(o,r,t+1/3),this.g=Qu(o,r,t),this.b=Qu(o,r,t-1/3)}return Se.colorSpaceToWorking(this,s),this}setStyle(t,e=Te){function n(r){r!==void 0&&parseFloat(r)<1&&jt("Color: Alpha component of "+t+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(t)){let r,o=s[1],a=s[2];switch(o){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,e);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,e);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return n(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,e);break;default:jt("Color: Unknown color model "+t)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(t)){let r=s[1],o=r.length;if(o===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,e);if(o===6)return this.setHex(parseInt(r,16),e);jt("Color: Invalid hex color "+t)}else if(t&&t.length>0)return this.setColorName(t,e);return this}setColorName(t,e=Te){let n=gg[t.toLowerCase()];return n!==void 0?this.setHex(n,e):jt("Color: Unknown color "+t),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(t){return this.r=t.r,this.g=t.g,this.b=t.b,this}copySRGBToLinear(t){return this.r=Ls(t.r),this.g=Ls(t.g),this.b=Ls(t.b),this}copyLinearToSRGB(t){return this.r=Eo(t.r),this.g=Eo(t.g),this.b=Eo(t.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(t=Te){return Se.workingToColorSpace(Kn.copy(this),t),Math.round(he(Kn.r*255,0,255))*65536+Math.round(he(Kn.g*255,0,255))*256+Math.round(he(Kn.b*255,0,255))}getHexString(t=Te){return("000000"+this.getHex(t).toString(16)).slice(-6)}getHSL(t,e=Se.workingColorSpace){Se.workingToColorSpace(Kn.copy(this),e);let n=Kn.r,s=Kn.g,r=Kn.b,o=Math.max(n,s,r),a=Math.min(n,s,r),l,c,d=(a+o)/2;if(a===o)l=0,c=0;else{let h=o-a;switch(c=d<=.5?h/(o+a):h/(2-o-a),o){case n:l=(s-r)/h+(s<r?6:0);break;case s:l=(r-n)/h+2;break;case r:l=(n-s)/h+4;break}l/=6}return t.h=l,t.s=c,t.l=d,t}getRGB(t,e=Se.workingColorSpace){return Se.workingToColorSpace(Kn.copy(this),e),t.r=Kn.r,t.g=Kn.g,t.b=Kn.b,t}getStyle(t=Te){Se.workingToColorSpace(Kn.copy(this),t);let e=Kn.r,n=Kn.g,s=Kn.b;return t!==Te?`color(${t} ${e.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(e*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(t,e,n){return this.getHSL(Ks),this.setHSL(Ks.h+t,Ks.s+e,Ks.l+n)}add(t){return this.r+=t.r,this.g+=t.g,this.b+=t.b,this}addColors(t,e){return this.r=t.r+e.r,this.g=t.g+e.g,this.b=t.b+e.b,this}addScalar(t){return this.r+=t,this.g+=t,this.b+=t,this}sub(t){return this.r=Math.max(0,this.r-t.r),this.g=Math.max(0,this.g-t.g),this.b=Math.max(0,this.b-t.b),this}multiply(t){return this.r*=t.r,this.g*=t.g,this.b*=t.b,this}multiplyScalar(t){return this.r*=t,this.g*=t,this.b*=t,this}lerp(t,e){return this.r+=(t.r-this.r)*e,this.g+=(t.g-this.g)*e,this.b+=(t.b-this.b)*e,this}lerpColors(t,e,n){return this.r=t.r+(e.r-t.r)*n,this.g=t.g+(e.g-t.g)*n,this.b=t.b+(e.b-t.b)*n,this}lerpHSL(t,e){this.getHSL(Ks),t.getHSL(Vl);let n=Ra(Ks.h,Vl.h,e),s=Ra(Ks.s,Vl.s,e),r=Ra(Ks.l,Vl.l,e);return this.setHSL(n,s,r),this}setFromVector3(t){return this.r=t.x,this.g=t.y,this.b=t.z,this}applyMatrix3(t){let e=this.r,n=this.g,s=this.b,r=t.elements;return this.r=r[0]*e+r[3]*n+r[6]*s,this.g=r[1]*e+r[4]*n+r[7]*s,this.b=r[2]*e+r[5]*n+r[8]*s,this}equals(t){return t.r===this.r&&t.g===this.g&&t.b===this.b}fromArray(t,e=0){return this.r=t[e],this.g=t[e+1],this.b=t[e+2],this}toArray(t=[],e=0){return t[e]=this.r,t[e+1]=this.g,t[e+2]=this.b,t}fromBufferAttribute(t,e){return this.r=t.getX(e),this.g=t.getY(e),this.b=t.getZ(e),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Kn=new Xt;Xt.NAMES=gg;var Ua=class i{constructor(t,e=25e-5){this.isFogExp2=!0,this.name="",this.color=new Xt(t),this.density=e}clone(){return new i(this.color,this.density)}toJSON(){return{type:"FogExp2",name:this.name,color:this.color.getHex(),density:this.density}}},No=class i{constructor(t,e=1,n=1e3){this.isFog=!0,this.name="",this.color=new Xt(t),this.near=e,this.far=n}clone(){return new i(this.color,this.near,this.far)}toJSON(){return{type:"Fog",name:this.name,color:this.color.getHex(),near:this.near,far:this.far}}},Fa=class extends Ee{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new Qn,this.environmentIntensity=1,this.environmentRotation=new Qn,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(t,e){return super.copy(t,e),this.background=t.background!==null?t.background.clone():null,this.environment=t.environment!==null?t.environment.clone():null,this.fog=t.fog!==null?t.fog.clone():null,this.backgroundBlurriness=t.backgroundBlurriness,this.backgroundIntensity=t.backgroundIntensity,this.backgroundRotation.copy(t.backgroundRotation),this.environmentIntensity=t.environmentIntensity,this.environmentRotation.copy(t.environmentRotation),this.overrideMaterial=t.overrideMaterial!==null?t.overrideMaterial.clone():null,this.matrixAutoUpdate=t.matrixAutoUpdate,this}toJSON(t){let e=super.toJSON(t);return this.fog!==null&&(e.object.fog=this.fog.toJSON()),e.object.backgroundBlurriness=this.backgroundBlurriness,e.object.backgroundIntensity=this.backgroundIntensity,e.object.backgroundRotation=this.backgroundRotation.toArray(),e.object.environmentIntensity=this.environmentIntensity,e.object.environmentRotation=this.environmentRotation.toArray(),e}},Yi=new R,As=new R,td=new R,Cs=new R,co=new R,ho=new R,om=new R,ed=new R,nd=new R,id=new R,sd=new De,rd=new De,od=new De,Is=class i{constructor(t=new R,e=new R,n=new R){this.a=t,this.b=e,this.c=n}static getNormal(t,e,n,s){s.subVectors(n,e),Yi.subVectors(t,e),s.cross(Yi);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(t,e,n,s,r){Yi.subVectors(s,e),As.subVectors(n,e),td.subVectors(t,e);let o=Yi.dot(Yi),a=Yi.dot(As),l=Yi.dot(td),c=As.dot(As),d=As.dot(td),h=o*c-a*a;if(h===0)return r.set(0,0,0),null;let u=1/h,f=(c*l-a*d)*u,p=(o*d-a*l)*u;return r.set(1-f-p,p,f)}static containsPoint(t,e,n,s){return this.getBarycoord(t,e,n,s,Cs)===null?!1:Cs.x>=0&&Cs.y>=0&&Cs.x+Cs.y<=1}static getInterpolation(t,e,n,s,r,o,a,l){return this.getBarycoord(t,e,n,s,Cs)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,Cs.x),l.addScaledVector(o,Cs.y),l.addScaledVector(a,Cs.z),l)}static getInterpolatedAttribute(t,e,n,s,r,o){return sd.setScalar(0),rd.setScalar(0),od.setScalar(0),sd.fromBufferAttribute(t,e),rd.fromBufferAttribute(t,n),od.fromBufferAttribute(t,s),o.setScalar(0),o.addScaledVector(sd,r.x),o.addScaledVector(rd,r.y),o.addScaledVector(od,r.z),o}static isFrontFacing(t,e,n,s){return Yi.subVectors(n,e),As.subVectors(t,e),Yi.cross(As).dot(s)<0}set(t,e,n){return this.a.copy(t),this.b.copy(e),this.c.copy(n),this}setFromPointsAndIndices(t,e,n,s){return this.a.copy(t[e]),this.b.copy(t[n]),this.c.copy(t[s]),this}setFromAttributeAndIndices(t,e,n,s){return this.a.fromBufferAttribute(t,e),this.b.fromBufferAttribute(t,n),this.c.fromBufferAttribute(t,s),this}clone(){return new this.constructor().copy(this)}copy(t){return this.a.copy(t.a),this.b.copy(t.b),this.c.copy(t.c),this}getArea(){return Yi.subVectors(this.c,this.b),As.subVectors(this.a,this.b),Yi.cross(As).length()*.5}getMidpoint(t){return t.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(t){return i.getNormal(this.a,this.b,this.c,t)}getPlane(t){return t.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(t,e){return i.getBarycoord(t,this.a,this.b,this.c,e)}getInterpolation(t,e,n,s,r){return i.getInterpolation(t,this.a,this.b,this.c,e,n,s,r)}containsPoint(t){return i.containsPoint(t,this.a,this.b,this.c)}isFrontFacing(t){return i.isFrontFacing(this.a,this.b,this.c,t)}intersectsBox(t){return t.intersectsTriangle(this)}closestPointToPoint(t,e){let n=this.a,s=this.b,r=this.c,o,a;co.subVectors(s,n),ho.subVectors(r,n),ed.subVectors(t,n);let l=co.dot(ed),c=ho.dot(ed);if(l<=0&&c<=0)return e.copy(n);nd.subVectors(t,s);let d=co.dot(nd),h=ho.dot(nd);if(d>=0&&h<=d)return e.copy(s);let u=l*h-d*c;if(u<=0&&l>=0&&d<=0&&l-d>0)return o=l/(l-d),e.copy(n).addScaledVector(co,o);id.subVectors(t,r);let f=co.dot(id),p=ho.dot(id);if(p>=0&&f<=p)return e.copy(r);let _=f*c-l*p;if(_<=0&&c>=0&&p<=0)return a=c/(c-p),e.copy(n).addScaledVector(ho,a);let m=d*p-f*h;if(m<=0&&h-d>=0&&f-p>=0)return om.subVectors(r,s),a=(h-d)/(h-d+(f-p)),e.copy(s).addScaledVector(om,a);let g=1/(m+_+u);return o=_*g,a=u*g,e.copy(n).addScaledVector(co,o).addScaledVector(ho,a)}equals(t){return t.a.equals(this.a)&&t.b.equals(this.b)&&t.c.equals(this.c)}},en=class{constructor(t=new R(1/0,1/0,1/0),e=new R(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=t,this.max=e}set(t,e){return this.min.copy(t),this.max.copy(e),this}setFromArray(t){this.makeEmpty();for(let e=0,n=t.length;e<n;e+=3)this.expandByPoint(qi.fromArray(t,e));return this}setFromBufferAttribute(t){this.makeEmpty();for(let e=0,n=t.count;e<n;e++)this.expandByPoint(qi.fromBufferAttribute(t,e));return this}setFromPoints(t){this.makeEmpty();for(let e=0,n=t.length;e<n;e++)this.expandByPoint(t[e]);return this}setFromCenterAndSize(t,e){let n=qi.copy(e).multiplyScalar(.5);return this.min.copy(t).sub(n),this.max.copy(t).add(n),this}setFromObject(t,e=!1){return this.makeEmpty(),this.expandByObject(t,e)}clone(){return new this.constructor().copy(this)}copy(t){return this.min.copy(t.min),this.max.copy(t.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(t){return this.isEmpty()?t.set(0,0,0):t.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(t){return this.isEmpty()?t.set(0,0,0):t.subVectors(this.max,this.min)}expandByPoint(t){return this.min.min(t),this.max.max(t),this}expandByVector(t){return this.min.sub(t),this.max.add(t),this}expandByScalar(t){return this.min.addScalar(-t),this.max.addScalar(t),this}expandByObject(t,e=!1){t.updateWorldMatrix(!1,!1);let n=t.geometry;if(n!==void 0){let r=n.getAttribute("position");if(e===!0&&r!==void 0&&t.isInstancedMesh!==!0&&t.isBatchedMesh!==!0)for(let o=0,a=r.count;o<a;o++)t.isMesh===!0?t.getVertexPosition(o,qi):qi.fromBufferAttribute(r,o),qi.applyMatrix4(t.matrixWorld),this.expandByPoint(qi);else t.boundingBox!==void 0?(t.boundingBox===null&&t.computeBoundingBox(),Gl.copy(t.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),Gl.copy(n.boundingBox)),Gl.applyMatrix4(t.matrixWorld),this.union(Gl)}let s=t.children;for(let r=0,o=s.length;r<o;r++)this.expandByObject(s[r],e);return this}containsPoint(t){return t.x>=this.min.x&&t.x<=this.max.x&&t.y>=this.min.y&&t.y<=this.max.y&&t.z>=this.min.z&&t.z<=this.max.z}containsBox(t){return this.min.x<=t.min.x&&t.max.x<=this.max.x&&this.min.y<=t.min.y&&t.max.y<=this.max.y&&this.min.z<=t.min.z&&t.max.z<=this.max.z}getParameter(t,e){return e.set((t.x-this.min.x)/(this.max.x-this.min.x),(t.y-this.min.y)/(this.max.y-this.min.y),(t.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(t){return t.max.x>=this.min.x&&t.min.x<=this.max.x&&t.max.y>=this.min.y&&t.min.y<=this.max.y&&t.max.z>=this.min.z&&t.min.z<=this.max.z}intersectsSphere(t){return this.clampPoint(t.center,qi),qi.distanceToSquared(t.center)<=t.radius*t.radius}intersectsPlane(t){let e,n;return t.normal.x>0?(e=t.normal.x*this.min.x,n=t.normal.x*this.max.x):(e=t.normal.x*this.max.x,n=t.normal.x*this.min.x),t.normal.y>0?(e+=t.normal.y*this.min.y,n+=t.normal.y*this.max.y):(e+=t.normal.y*this.max.y,n+=t.normal.y*this.min.y),t.normal.z>0?(e+=t.normal.z*this.min.z,n+=t.normal.z*this.max.z):(e+=t.normal.z*this.max.z,n+=t.normal.z*this.min.z),e<=-t.constant&&n>=-t.constant}intersectsTriangle(t){if(this.isEmpty())return!1;this.getCenter(xa),Hl.subVectors(this.max,xa),uo.subVectors(t.a,xa),fo.subVectors(t.b,xa),po.subVectors(t.c,xa),Qs.subVectors(fo,uo),tr.subVectors(po,fo),Mr.subVectors(uo,po);let e=[0,-Qs.z,Qs.y,0,-tr.z,tr.y,0,-Mr.z,Mr.y,Qs.z,0,-Qs.x,tr.z,0,-tr.x,Mr.z,0,-Mr.x,-Qs.y,Qs.x,0,-tr.y,tr.x,0,-Mr.y,Mr.x,0];return!ad(e,uo,fo,po,Hl)||(e=[1,0,0,0,1,0,0,0,1],!ad(e,uo,fo,po,Hl))?!1:(Wl.crossVectors(Qs,tr),e=[Wl.x,Wl.y,Wl.z],ad(e,uo,fo,po,Hl))}clampPoint(t,e){return e.copy(t).clamp(this.min,this.max)}distanceToPoint(t){return this.clampPoint(t,qi).distanceTo(t)}getBoundingSphere(t){return this.isEmpty()?t.makeEmpty():(this.getCenter(t.center),t.radius=this.getSize(qi).length()*.5),t}intersect(t){return this.min.max(t.min),this.max.min(t.max),this.isEmpty()&&this.makeEmpty(),this}union(t){return this.min.min(t.min),this.max.max(t.max),this}applyMatrix4(t){return this.isEmpty()?this:(Rs[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(t),Rs[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(t),Rs[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(t),Rs[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(t),Rs[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(t),Rs[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(t),Rs[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(t),Rs[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(t),this.setFromPoints(Rs),this)}translate(t){return this.min.add(t),this.max.add(t),this}equals(t){return t.min.equals(this.min)&&t.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(t){return this.min.fromArray(t.min),this.max.fromArray(t.max),this}},Rs=[new R,new R,new R,new R,new R,new R,new R,new R],qi=new R,Gl=new en,uo=new R,fo=new R,po=new R,Qs=new R,tr=new R,Mr=new R,xa=new R,Hl=new R,Wl=new R,wr=new R;function ad(i,t,e,n,s){for(let r=0,o=i.length-3;r<=o;r+=3){wr.fromArray(i,r);let a=s.x*Math.abs(wr.x)+s.y*Math.abs(wr.y)+s.z*Math.abs(wr.z),l=t.dot(wr),c=e.dot(wr),d=n.dot(wr);if(Math.max(-Math.max(l,c,d),Math.min(l,c,d))>a)return!1}return!0}var Sn=new R,Xl=new Bt,Py=0,Le=class extends $i{constructor(t,e,n=!1){if(super(),Array.isArray(t))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Py++}),this.name="",this.array=t,this.itemSize=e,this.count=t!==void 0?t.length/e:0,this.normalized=n,this.usage=Kd,this.updateRanges=[],this.gpuType=Fi,this.version=0,this._normalizationScale=t!==void 0?Nh(t):void 0}onUploadCallback(){}set needsUpdate(t){t===!0&&this.version++}setUsage(t){return this.usage=t,this}addUpdateRange(t,e){this.updateRanges.push({start:t,count:e})}clearUpdateRanges(){this.updateRanges.length=0}copy(t){return this.name=t.name,this.array=new t.array.constructor(t.array),this.itemSize=t.itemSize,this.count=t.count,this.normalized=t.normalized,this.usage=t.usage,this.gpuType=t.gpuType,this._normalizationScale=t._normalizationScale,this}copyAt(t,e,n){t*=this.itemSize,n*=e.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[t+s]=e.array[n+s];return this}copyArray(t){return this.array.set(t),this}applyMatrix3(t){if(this.itemSize===2)for(let e=0,n=this.count;e<n;e++)Xl.fromBufferAttribute(this,e),Xl.applyMatrix3(t),this.setXY(e,Xl.x,Xl.y);else if(this.itemSize===3)for(let e=0,n=this.count;e<n;e++)Sn.fromBufferAttribute(this,e),Sn.applyMatrix3(t),this.setXYZ(e,Sn.x,Sn.y,Sn.z);return this}applyMatrix4(t){for(let e=0,n=this.count;e<n;e++)Sn.fromBufferAttribute(this,e),Sn.applyMatrix4(t),this.setXYZ(e,Sn.x,Sn.y,Sn.z);return this}applyNormalMatrix(t){for(let e=0,n=this.count;e<n;e++)Sn.fromBufferAttribute(this,e),Sn.applyNormalMatrix(t),this.setXYZ(e,Sn.x,Sn.y,Sn.z);return this}transformDirection(t){for(let e=0,n=this.count;e<n;e++)Sn.fromBufferAttribute(this,e),Sn.transformDirection(t),this.setXYZ(e,Sn.x,Sn.y,Sn.z);return this}set(t,e=0){return this.array.set(t,e),this}getComponent(t,e){let n=this.array[t*this.itemSize+e];return this.normalized&&(n=this._denormalize(n)),n}setComponent(t,e,n){return this.normalized&&(n=this._normalize(n)),this.array[t*this.itemSize+e]=n,this}getX(t){let e=this.array[t*this.itemSize];return this.normalized&&(e=this._denormalize(e)),e}setX(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize]=e,this}getY(t){let e=this.array[t*this.itemSize+1];return this.normalized&&(e=this._denormalize(e)),e}setY(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize+1]=e,this}getZ(t){let e=this.array[t*this.itemSize+2];return this.normalized&&(e=this._denormalize(e)),e}setZ(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize+2]=e,this}getW(t){let e=this.array[t*this.itemSize+3];return this.normalized&&(e=this._denormalize(e)),e}setW(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize+3]=e,this}setXY(t,e,n){return t*=this.itemSize,this.normalized&&(e=this._normalize(e),n=this._normalize(n)),this.array[t+0]=e,this.array[t+1]=n,this}setXYZ(t,e,n,s){return t*=this.itemSize,this.normalized&&(e=this._normalize(e),n=this._normalize(n),s=this._normalize(s)),this.array[t+0]=e,this.array[t+1]=n,this.array[t+2]=s,this}setXYZW(t,e,n,s,r){return t*=this.itemSize,this.normalized&&(e=this._normalize(e),n=this._normalize(n),s=this._normalize(s),r=this._normalize(r)),this.array[t+0]=e,this.array[t+1]=n,this.array[t+2]=s,this.array[t+3]=r,this}onUpload(t){return this.onUploadCallback=t,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let t={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return t.name=this.name,t.usage=this.usage,t.gpuType=this.gpuType,t}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(t){let e=this._normalizationScale;return e!==void 0?Math.max(t/e,-1):nf(t,this.array)}_normalize(t){let e=this._normalizationScale;return e!==void 0?Math.round(t*e):sf(t,this.array)}};var Ba=class extends Le{constructor(t,e,n){super(new Uint16Array(t),e,n)}};var ka=class extends Le{constructor(t,e,n){super(new Uint32Array(t),e,n)}};var ie=class extends Le{constructor(t,e,n){super(new Float32Array(t),e,n)}},Iy=new en,ya=new R,ld=new R,mi=class{constructor(t=new R,e=-1){this.isSphere=!0,this.center=t,this.radius=e}set(t,e){return this.center.copy(t),this.radius=e,this}setFromPoints(t,e){let n=this.center;e!==void 0?n.copy(e):Iy.setFromPoints(t).getCenter(n);let s=0;for(let r=0,o=t.length;r<o;r++)s=Math.max(s,n.distanceToSquared(t[r]));return this.radius=Math.sqrt(s),this}copy(t){return this.center.copy(t.center),this.radius=t.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(t){return t.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(t){return t.distanceTo(this.center)-this.radius}intersectsSphere(t){let e=this.radius+t.radius;return t.center.distanceToSquared(this.center)<=e*e}intersectsBox(t){return t.intersectsSphere(this)}intersectsPlane(t){return Math.abs(t.distanceToPoint(this.center))<=this.radius}clampPoint(t,e){let n=this.center.distanceToSquared(t);return e.copy(t),n>this.radius*this.radius&&(e.sub(this.center).normalize(),e.multiplyScalar(this.radius).add(this.center)),e}getBoundingBox(t){return this.isEmpty()?(t.makeEmpty(),t):(t.set(this.center,this.center),t.expandByScalar(this.radius),t)}applyMatrix4(t){return this.center.applyMatrix4(t),this.radius=this.radius*t.getMaxScaleOnAxis(),this}translate(t){return this.center.add(t),this}expandByPoint(t){if(this.isEmpty())return this.center.copy(t),this.radius=0,this;ya.subVectors(t,this.center);let e=ya.lengthSq();if(e>this.radius*this.radius){let n=Math.sqrt(e),s=(n-this.radius)*.5;this.center.addScaledVector(ya,s/n),this.radius+=s}return this}union(t){return t.isEmpty()?this:this.isEmpty()?(this.copy(t),this):(this.center.equals(t.center)===!0?this.radius=Math.max(this.radius,t.radius):(ld.subVectors(t.center,this.center).setLength(t.radius),this.expandByPoint(ya.copy(t.center).add(ld)),this.expandByPoint(ya.copy(t.center).sub(ld))),this)}equals(t){return t.center.equals(this.center)&&t.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(t){return this.radius=t.radius,this.center.fromArray(t.center),this}},Ly=0,Ni=new Wt,cd=new Ee,mo=new R,Ti=new en,va=new en,kn=new R,pe=class i extends $i{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:Ly++}),this.uuid=pr(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(t){return Array.isArray(t)?this.index=new(iy(t)?ka:Ba)(t,1):this.index=t,this}setIndirect(t,e=0){return this.indirect=t,this.indirectOffset=e,this}getIndirect(){return this.indirect}getAttribute(t){return this.attributes[t]}setAttribute(t,e){return this.attributes[t]=e,this}deleteAttribute(t){return delete this.attributes[t],this}hasAttribute(t){return this.attributes[t]!==void 0}addGroup(t,e,n=0){this.groups.push({start:t,count:e,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(t,e){this.drawRange.start=t,this.drawRange.count=e}applyMatrix4(t){let e=this.attributes.position;e!==void 0&&(e.applyMatrix4(t),e.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let r=new re().getNormalMatrix(t);n.applyNormalMatrix(r),n.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(t),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(t){return Ni.makeRotationFromQuaternion(t),this.applyMatrix4(Ni),this}rotateX(t){return Ni.makeRotationX(t),this.applyMatrix4(Ni),this}rotateY(t){return Ni.makeRotationY(t),this.applyMatrix4(Ni),this}rotateZ(t){return Ni.makeRotationZ(t),this.applyMatrix4(Ni),this}translate(t,e,n){return Ni.makeTranslation(t,e,n),this.applyMatrix4(Ni),this}scale(t,e,n){return Ni.makeScale(t,e,n),this.applyMatrix4(Ni),this}lookAt(t){return cd.lookAt(t),cd.updateMatrix(),this.applyMatrix4(cd.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(mo).negate(),this.translate(mo.x,mo.y,mo.z),this}setFromPoints(t){let e=this.getAttribute("position");if(e===void 0){let n=[];for(let s=0,r=t.length;s<r;s++){let o=t[s];n.push(o.x,o.y,o.z||0)}this.setAttribute("position",new ie(n,3))}else{let n=Math.min(t.length,e.count);for(let s=0;s<n;s++){let r=t[s];e.setXYZ(s,r.x,r.y,r.z||0)}t.length>e.count&&jt("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),e.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new en);let t=this.attributes.position,e=this.morphAttributes.position;if(t&&t.isGLBufferAttribute){te("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new R(-1/0,-1/0,-1/0),new R(1/0,1/0,1/0));return}if(t!==void 0){if(this.boundingBox.setFromBufferAttribute(t),e)for(let n=0,s=e.length;n<s;n++){let r=e[n];Ti.setFromBufferAttribute(r),this.morphTargetsRelative?(kn.addVectors(this.boundingBox.min,Ti.min),this.boundingBox.expandByPoint(kn),kn.addVectors(this.boundingBox.max,Ti.max),this.boundingBox.expandByPoint(kn)):(this.boundingBox.expandByPoint(Ti.min),this.boundingBox.expandByPoint(Ti.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&te('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new mi);let t=this.attributes.position,e=this.morphAttributes.position;if(t&&t.isGLBufferAttribute){te("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new R,1/0);return}if(t){let n=this.boundingSphere.center;if(Ti.setFromBufferAttribute(t),e)for(let r=0,o=e.length;r<o;r++){let a=e[r];va.setFromBufferAttribute(a),this.morphTargetsRelative?(kn.addVectors(Ti.min,va.min),Ti.expandByPoint(kn),kn.addVectors(Ti.max,va.max),Ti.expandByPoint(kn)):(Ti.expandByPoint(va.min),Ti.expandByPoint(va.max))}Ti.getCenter(n);let s=0;for(let r=0,o=t.count;r<o;r++)kn.fromBufferAttribute(t,r),s=Math.max(s,n.distanceToSquared(kn));if(e)for(let r=0,o=e.length;r<o;r++){let a=e[r],l=this.morphTargetsRelative;for(let c=0,d=a.count;c<d;c++)kn.fromBufferAttribute(a,c),l&&(mo.fromBufferAttribute(t,c),kn.add(mo)),s=Math.max(s,n.distanceToSquared(kn))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&te('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let t=this.index,e=this.attributes;if(t===null||e.position===void 0||e.normal===void 0||e.uv===void 0){te("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let n=e.position,s=e.normal,r=e.uv,o=this.getAttribute("tangent");(o===void 0||o.count!==n.count)&&(o=new Le(new Float32Array(4*n.count),4),this.setAttribute("tangent",o));let a=[],l=[],c=new Uint8Array(n.count);for(let O=0;O<n.count;O++)a[O]=new R,l[O]=new R;let d=new R,h=new R,u=new R,f=new Bt,p=new Bt,_=new Bt,m=new R,g=new R;function y(O,P,L){c[O]=c[P]=c[L]=1,d.fromBufferAttribute(n,O),h.fromBufferAttribute(n,P),u.fromBufferAttribute(n,L),f.fromBufferAttribute(r,O),p.fromBufferAttribute(r,P),_.fromBufferAttribute(r,L),h.sub(d),u.sub(d),p.sub(f),_.sub(f);let B=1/(p.x*_.y-_.x*p.y);isFinite(B)&&(m.copy(h).multiplyScalar(_.y).addScaledVector(u,-p.y).multiplyScalar(B),g.copy(u).multiplyScalar(p.x).addScaledVector(h,-_.x).multiplyScalar(B),a[O].add(m),a[P].add(m),a[L].add(m),l[O].add(g),l[P].add(g),l[L].add(g))}let T=this.groups;T.length===0&&(T=[{start:0,count:t.count}]);for(let O=0,P=T.length;O<P;++O){let L=T[O],B=L.start,G=L.count;for(let D=B,X=B+G;D<X;D+=3)y(t.getX(D+0),t.getX(D+1),t.getX(D+2))}let v=new R,M=new R,b=new R,x=new R;function w(O){b.fromBufferAttribute(s,O),x.copy(b);let P=a[O];v.copy(P),v.sub(b.multiplyScalar(b.dot(P))).normalize(),M.crossVectors(x,P);let B=M.dot(l[O])<0?-1:1;o.setXYZW(O,v.x,v.y,v.z,B)}for(let O=0,P=n.count;O<P;++O)c[O]&&w(O);this._transformed=!0}computeVertexNormals(){let t=this.index,e=this.getAttribute("position");if(e!==void 0){let n=this.getAttribute("normal");if(n===void 0||n.count!==e.count)n=new Le(new Float32Array(e.count*3),3),this.setAttribute("normal",n);else for(let u=0,f=n.count;u<f;u++)n.setXYZ(u,0,0,0);let s=new R,r=new R,o=new R,a=new R,l=new R,c=new R,d=new R,h=new R;if(t)for(let u=0,f=t.count;u<f;u+=3){let p=t.getX(u+0),_=t.getX(u+1),m=t.getX(u+2);s.fromBufferAttribute(e,p),r.fromBufferAttribute(e,_),o.fromBufferAttribute(e,m),d.subVectors(o,r),h.subVectors(s,r),d.cross(h),a.fromBufferAttribute(n,p),l.fromBufferAttribute(n,_),c.fromBufferAttribute(n,m),a.add(d),l.add(d),c.add(d),n.setXYZ(p,a.x,a.y,a.z),n.setXYZ(_,l.x,l.y,l.z),n.setXYZ(m,c.x,c.y,c.z)}else for(let u=0,f=e.count;u<f;u+=3)s.fromBufferAttribute(e,u+0),r.fromBufferAttribute(e,u+1),o.fromBufferAttribute(e,u+2),d.subVectors(o,r),h.subVectors(s,r),d.cross(h),n.setXYZ(u+0,d.x,d.y,d.z),n.setXYZ(u+1,d.x,d.y,d.z),n.setXYZ(u+2,d.x,d.y,d.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let t=this.attributes.normal;for(let e=0,n=t.count;e<n;e++)kn.fromBufferAttribute(t,e),kn.normalize(),t.setXYZ(e,kn.x,kn.y,kn.z)}toNonIndexed(){function t(a,l){let c=a.array,d=a.itemSize,h=a.normalized,u=new c.constructor(l.length*d),f=0,p=0;for(let _=0,m=l.length;_<m;_++){a.isInterleavedBufferAttribute?f=l[_]*a.data.stride+a.offset:f=l[_]*d;for(let g=0;g<d;g++)u[p++]=c[f++]}return new Le(u,d,h)}if(this.index===null)return jt("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let e=new i,n=this.index.array,s=this.attributes;for(let a in s){let l=s[a],c=t(l,n);e.setAttribute(a,c)}let r=this.morphAttributes;for(let a in r){let l=[],c=r[a];for(let d=0,h=c.length;d<h;d++){let u=c[d],f=t(u,n);l.push(f)}e.morphAttributes[a]=l}e.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let a=0,l=o.length;a<l;a++){let c=o[a];e.addGroup(c.start,c.count,c.materialIndex)}return e}toJSON(){let t={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(t.uuid=this.uuid,t.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,t.name=this.name,Object.keys(this.userData).length>0&&(t.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let l=this.parameters;for(let c in l)l[c]!==void 0&&(t[c]=l[c]);return t}t.data={attributes:{}};let e=this.index;e!==null&&(t.data.index={type:e.array.constructor.name,array:Array.prototype.slice.call(e.array)});let n=this.attributes;for(let l in n){let c=n[l];t.data.attributes[l]=c.toJSON(t.data)}let s={},r=!1;for(let l in this.morphAttributes){let c=this.morphAttributes[l],d=[];for(let h=0,u=c.length;h<u;h++){let f=c[h];d.push(f.toJSON(t.data))}d.length>0&&(s[l]=d,r=!0)}r&&(t.data.morphAttributes=s,t.data.morphTargetsRelative=this.morphTargetsRelative);let o=this.groups;o.length>0&&(t.data.groups=JSON.parse(JSON.stringify(o)));let a=this.boundingSphere;return a!==null&&(t.data.boundingSphere=a.toJSON()),t}clone(){return new this.constructor().copy(this)}copy(t){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let e={};this.name=t.name;let n=t.index;n!==null&&this.setIndex(n.clone());let s=t.attributes;for(let c in s){let d=s[c];this.setAttribute(c,d.clone(e))}let r=t.morphAttributes;for(let c in r){let d=[],h=r[c];for(let u=0,f=h.length;u<f;u++)d.push(h[u].clone(e));this.morphAttributes[c]=d}this.morphTargetsRelative=t.morphTargetsRelative;let o=t.groups;for(let c=0,d=o.length;c<d;c++){let h=o[c];this.addGroup(h.start,h.count,h.materialIndex)}let a=t.boundingBox;a!==null&&(this.boundingBox=a.clone());let l=t.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=t.drawRange.start,this.drawRange.count=t.drawRange.count,this.userData=t.userData,this._transformed=t._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}},za=class{constructor(t,e){this.isInterleavedBuffer=!0,this.array=t,this.stride=e,this.count=t!==void 0?t.length/e:0,this.usage=Kd,this.updateRanges=[],this.version=0,this.uuid=pr()}onUploadCallback(){}set needsUpdate(t){t===!0&&this.version++}setUsage(t){return this.usage=t,this}addUpdateRange(t,e){this.updateRanges.push({start:t,count:e})}clearUpdateRanges(){this.updateRanges.length=0}copy(t){return this.array=new t.array.constructor(t.array),this.count=t.count,this.stride=t.stride,this.usage=t.usage,this}copyAt(t,e,n){t*=this.stride,n*=e.stride;for(let s=0,r=this.stride;s<r;s++)this.array[t+s]=e.array[n+s];return this}set(t,e=0){return this.array.set(t,e),this}clone(t){t.arrayBuffers===void 0&&(t.arrayBuffers={});let e=am(this.array);t.arrayBuffers[e]===void 0&&(t.arrayBuffers[e]=this.array.slice(0).buffer);let n=new this.array.constructor(t.arrayBuffers[e]),s=new this.constructor(n,this.stride);return s.setUsage(this.usage),s}onUpload(t){return this.onUploadCallback=t,this}toJSON(t){t.arrayBuffers===void 0&&(t.arrayBuffers={});let e=am(this.array);t.arrayBuffers[e]===void 0&&(t.arrayBuffers[e]=Array.from(new Uint32Array(this.array.slice(0).buffer)));let n={uuid:this.uuid,buffer:e,type:this.array.constructor.name,stride:this.stride};return n.usage=this.usage,n}};function am(i){return i.buffer._uuid===void 0&&(i.buffer._uuid=pr()),i.byteOffset===0&&i.byteLength===i.buffer.byteLength?i.buffer._uuid:i.buffer._uuid+":"+i.byteOffset+":"+i.byteLength}var li=new R,Ei=class i{constructor(t,e,n,s=!1){this.isInterleavedBufferAttribute=!0,this.name="",this.data=t,this.itemSize=e,this.offset=n,this.normalized=s,this._normalizationScale=t!==void 0?Nh(t.array):void 0}get count(){return this.data.count}get array(){return this.data.array}set needsUpdate(t){this.data.needsUpdate=t}applyMatrix4(t){for(let e=0,n=this.data.count;e<n;e++)li.fromBufferAttribute(this,e),li.applyMatrix4(t),this.setXYZ(e,li.x,li.y,li.z);return this}applyNormalMatrix(t){for(let e=0,n=this.count;e<n;e++)li.fromBufferAttribute(this,e),li.applyNormalMatrix(t),this.setXYZ(e,li.x,li.y,li.z);return this}transformDirection(t){for(let e=0,n=this.count;e<n;e++)li.fromBufferAttribute(this,e),li.transformDirection(t),this.setXYZ(e,li.x,li.y,li.z);return this}getComponent(t,e){let n=this.array[t*this.data.stride+this.offset+e];return this.normalized&&(n=this._denormalize(n)),n}setComponent(t,e,n){return this.normalized&&(n=this._normalize(n)),this.data.array[t*this.data.stride+this.offset+e]=n,this}setX(t,e){return this.normalized&&(e=this._normalize(e)),this.data.array[t*this.data.stride+this.offset]=e,this}setY(t,e){return this.normalized&&(e=this._normalize(e)),this.data.array[t*this.data.stride+this.offset+1]=e,this}setZ(t,e){return this.normalized&&(e=this._normalize(e)),this.data.array[t*this.data.stride+this.offset+2]=e,this}setW(t,e){return this.normalized&&(e=this._normalize(e)),this.data.array[t*this.data.stride+this.offset+3]=e,this}getX(t){let e=this.data.array[t*this.data.stride+this.offset];return this.normalized&&(e=this._denormalize(e)),e}getY(t){let e=this.data.array[t*this.data.stride+this.offset+1];return this.normalized&&(e=this._denormalize(e)),e}getZ(t){let e=this.data.array[t*this.data.stride+this.offset+2];return this.normalized&&(e=this._denormalize(e)),e}getW(t){let e=this.data.array[t*this.data.stride+this.offset+3];return this.normalized&&(e=this._denormalize(e)),e}setXY(t,e,n){return t=t*this.data.stride+this.offset,this.normalized&&(e=this._normalize(e),n=this._normalize(n)),this.data.array[t+0]=e,this.data.array[t+1]=n,this}setXYZ(t,e,n,s){return t=t*this.data.stride+this.offset,this.normalized&&(e=this._normalize(e),n=this._normalize(n),s=this._normalize(s)),this.data.array[t+0]=e,this.data.array[t+1]=n,this.data.array[t+2]=s,this}setXYZW(t,e,n,s,r){return t=t*this.data.stride+this.offset,this.normalized&&(e=this._normalize(e),n=this._normalize(n),s=this._normalize(s),r=this._normalize(r)),this.data.array[t+0]=e,this.data.array[t+1]=n,this.data.array[t+2]=s,this.data.array[t+3]=r,this}clone(t){if(t===void 0){Na("InterleavedBufferAttribute.clone(): Cloning an interleaved buffer attribute will de-interleave buffer data.");let e=[];for(let n=0;n<this.count;n++){let s=n*this.data.stride+this.offset;for(let r=0;r<this.itemSize;r++)e.push(this.data.array[s+r])}return new Le(new this.array.constructor(e),this.itemSize,this.normalized)}else return t.interleavedBuffers===void 0&&(t.interleavedBuffers={}),t.interleavedBuffers[this.data.uuid]===void 0&&(t.interleavedBuffers[this.data.uuid]=this.data.clone(t)),new i(t.interleavedBuffers[this.data.uuid],this.itemSize,this.offset,this.normalized)}toJSON(t){if(t===void 0){Na("InterleavedBufferAttribute.toJSON(): Serializing an interleaved buffer attribute will de-interleave buffer data.");let e=[];for(let n=0;n<this.count;n++){let s=n*this.data.stride+this.offset;for(let r=0;r<this.itemSize;r++)e.push(this.data.array[s+r])}return{itemSize:this.itemSize,type:this.array.constructor.name,array:e,normalized:this.normalized}}else return t.interleavedBuffers===void 0&&(t.interleavedBuffers={}),t.interleavedBuffers[this.data.uuid]===void 0&&(t.interleavedBuffers[this.data.uuid]=this.data.toJSON(t)),{isInterleavedBufferAttribute:!0,itemSize:this.itemSize,data:this.data.uuid,offset:this.offset,normalized:this.normalized}}_denormalize(t){let e=this._normalizationScale;return e!==void 0?Math.max(t/e,-1):nf(t,this.data.array)}_normalize(t){let e=this._normalizationScale;return e!==void 0?Math.round(t*e):sf(t,this.data.array)}},hd=new R,Dy=new R,Ny=new re,En=class{constructor(t=new R(1,0,0),e=0){this.isPlane=!0,this.normal=t,this.constant=e}set(t,e){return this.normal.copy(t),this.constant=e,this}setComponents(t,e,n,s){return this.normal.set(t,e,n),this.constant=s,this}setFromNormalAndCoplanarPoint(t,e){return this.normal.copy(t),this.constant=-e.dot(this.normal),this}setFromCoplanarPoints(t,e,n){let s=hd.subVectors(n,e).cross(Dy.subVectors(t,e)).normalize();return this.setFromNormalAndCoplanarPoint(s,t),this}copy(t){return this.normal.copy(t.normal),this.constant=t.constant,this}normalize(){let t=1/this.normal.length();return this.normal.multiplyScalar(t),this.constant*=t,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(t){return this.normal.dot(t)+this.constant}distanceToSphere(t){return this.distanceToPoint(t.center)-t.radius}projectPoint(t,e){return e.copy(t).addScaledVector(this.normal,-this.distanceToPoint(t))}intersectLine(t,e,n=!0){let s=t.delta(hd),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(t.start)===0?e.copy(t.start):null;let o=-(t.start.dot(this.normal)+this.constant)/r;return n===!0&&(o<0||o>1)?null:e.copy(t.start).addScaledVector(s,o)}intersectsLine(t){let e=this.distanceToPoint(t.start),n=this.distanceToPoint(t.end);return e<0&&n>0||n<0&&e>0}intersectsBox(t){return t.intersectsPlane(this)}intersectsSphere(t){return t.intersectsPlane(this)}coplanarPoint(t){return t.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(t,e){let n=e||Ny.getNormalMatrix(t),s=this.coplanarPoint(hd).applyMatrix4(t),r=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(r),this}translate(t){return this.constant-=t.dot(this.normal),this}equals(t){return t.normal.equals(this.normal)&&t.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(t){return this.normal.fromArray(t.normal),this.constant=t.constant,this}},Oy=0,Ui=class extends $i{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:Oy++}),this.uuid=pr(),this.name="",this.type="Material",this.blending=Go,this.side=dr,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=Dd,this.blendDst=Nd,this.blendEquation=Dr,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new Xt(0,0,0),this.blendAlpha=0,this.depthFunc=Ao,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=og,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=gc,this.stencilZFail=gc,this.stencilZPass=gc,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(t){this._alphaTest>0!=t>0&&this.version++,this._alphaTest=t}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(t){if(t!==void 0)for(let e in t){let n=t[e];if(n===void 0){jt(`Material: parameter '${e}' has value of undefined.`);continue}let s=this[e];if(s===void 0){jt(`Material: '${e}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector2&&n&&n.isVector2||s&&s.isEuler&&n&&n.isEuler||s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[e]=n}}toJSON(t){let e=t===void 0||typeof t=="string";e&&(t={textures:{},images:{}});let n={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(t).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(t).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(t).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(t).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(t).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(t).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(t).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(t).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(t).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(t).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(t).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(t).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(t).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(t).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(t).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(t).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(t).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(t).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(t).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(t).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(t).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(t).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(t).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(t).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(t).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(t).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(t).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(r){let o=[];for(let a in r){let l=r[a];delete l.metadata,o.push(l)}return o}if(e){let r=s(t.textures),o=s(t.images);r.length>0&&(n.textures=r),o.length>0&&(n.images=o)}return n}fromJSON(t,e){if(t.uuid!==void 0&&(this.uuid=t.uuid),t.name!==void 0&&(this.name=t.name),t.color!==void 0&&this.color!==void 0&&this.color.setHex(t.color),t.roughness!==void 0&&(this.roughness=t.roughness),t.metalness!==void 0&&(this.metalness=t.metalness),t.sheen!==void 0&&(this.sheen=t.sheen),t.sheenColor!==void 0&&(this.sheenColor=new Xt().setHex(t.sheenColor)),t.sheenRoughness!==void 0&&(this.sheenRoughness=t.sheenRoughness),t.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(t.emissive),t.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(t.specular),t.specularIntensity!==void 0&&(this.specularIntensity=t.specularIntensity),t.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(t.specularColor),t.shininess!==void 0&&(this.shininess=t.shininess),t.clearcoat!==void 0&&(this.clearcoat=t.clearcoat),t.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=t.clearcoatRoughness),t.diffuseRoughness!==void 0&&(this.diffuseRoughness=t.diffuseRoughness),t.dispersion!==void 0&&(this.dispersion=t.dispersion),t.retroreflectivity!==void 0&&(this.retroreflectivity=t.retroreflectivity),t.iridescence!==void 0&&(this.iridescence=t.iridescence),t.iridescenceIOR!==void 0&&(this.iridescenceIOR=t.iridescenceIOR),t.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=t.iridescenceThicknessMinimum),t.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=t.iridescenceThicknessMaximum),t.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=t.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=t.iridescenceThicknessRange[1]),t.transmission!==void 0&&(this.transmission=t.transmission),t.thickness!==void 0&&(this.thickness=t.thickness),t.attenuationDistance!==void 0&&(this.attenuationDistance=t.attenuationDistance),t.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(t.attenuationColor),t.anisotropy!==void 0&&(this.anisotropy=t.anisotropy),t.anisotropyRotation!==void 0&&(this.anisotropyRotation=t.anisotropyRotation),t.fog!==void 0&&(this.fog=t.fog),t.flatShading!==void 0&&(this.flatShading=t.flatShading),t.blending!==void 0&&(this.blending=t.blending),t.combine!==void 0&&(this.combine=t.combine),t.side!==void 0&&(this.side=t.side),t.shadowSide!==void 0&&(this.shadowSide=t.shadowSide),t.opacity!==void 0&&(this.opacity=t.opacity),t.transparent!==void 0&&(this.transparent=t.transparent),t.alphaTest!==void 0&&(this.alphaTest=t.alphaTest),t.alphaHash!==void 0&&(this.alphaHash=t.alphaHash),t.depthFunc!==void 0&&(this.depthFunc=t.depthFunc),t.depthTest!==void 0&&(this.depthTest=t.depthTest),t.depthWrite!==void 0&&(this.depthWrite=t.depthWrite),t.colorWrite!==void 0&&(this.colorWrite=t.colorWrite),t.clippingPlanes!==void 0&&(this.clippingPlanes=t.clippingPlanes.map(n=>new En().fromJSON(n))),t.clipIntersection!==void 0&&(this.clipIntersection=t.clipIntersection),t.clipShadows!==void 0&&(this.clipShadows=t.clipShadows),t.depthPacking!==void 0&&(this.depthPacking=t.depthPacking),t.blendSrc!==void 0&&(this.blendSrc=t.blendSrc),t.blendDst!==void 0&&(this.blendDst=t.blendDst),t.blendEquation!==void 0&&(this.blendEquation=t.blendEquation),t.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=t.blendSrcAlpha),t.blendDstAlpha!==void 0&&(this.blendDstAlpha=t.blendDstAlpha),t.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=t.blendEquationAlpha),t.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(t.blendColor),t.blendAlpha!==void 0&&(this.blendAlpha=t.blendAlpha),t.stencilWriteMask!==void 0&&(this.stencilWriteMask=t.stencilWriteMask),t.stencilFunc!==void 0&&(this.stencilFunc=t.stencilFunc),t.stencilRef!==void 0&&(this.stencilRef=t.stencilRef),t.stencilFuncMask!==void 0&&(this.stencilFuncMask=t.stencilFuncMask),t.stencilFail!==void 0&&(this.stencilFail=t.stencilFail),t.stencilZFail!==void 0&&(this.stencilZFail=t.stencilZFail),t.stencilZPass!==void 0&&(this.stencilZPass=t.stencilZPass),t.stencilWrite!==void 0&&(this.stencilWrite=t.stencilWrite),t.wireframe!==void 0&&(this.wireframe=t.wireframe),t.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=t.wireframeLinewidth),t.wireframeLinecap!==void 0&&(this.wireframeLinecap=t.wireframeLinecap),t.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=t.wireframeLinejoin),t.rotation!==void 0&&(this.rotation=t.rotation),t.linewidth!==void 0&&(this.linewidth=t.linewidth),t.linecap!==void 0&&(this.linecap=t.linecap),t.linejoin!==void 0&&(this.linejoin=t.linejoin),t.dashSize!==void 0&&(this.dashSize=t.dashSize),t.gapSize!==void 0&&(this.gapSize=t.gapSize),t.scale!==void 0&&(this.scale=t.scale),t.polygonOffset!==void 0&&(this.polygonOffset=t.polygonOffset),t.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=t.polygonOffsetFactor),t.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=t.polygonOffsetUnits),t.dithering!==void 0&&(this.dithering=t.dithering),t.alphaToCoverage!==void 0&&(this.alphaToCoverage=t.alphaToCoverage),t.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=t.premultipliedAlpha),t.forceSinglePass!==void 0&&(this.forceSinglePass=t.forceSinglePass),t.allowOverride!==void 0&&(this.allowOverride=t.allowOverride),t.visible!==void 0&&(this.visible=t.visible),t.toneMapped!==void 0&&(this.toneMapped=t.toneMapped),t.userData!==void 0&&(this.userData=t.userData),t.vertexColors!==void 0&&(typeof t.vertexColors=="number"?this.vertexColors=t.vertexColors>0:this.vertexColors=t.vertexColors),t.size!==void 0&&(this.size=t.size),t.sizeAttenuation!==void 0&&(this.sizeAttenuation=t.sizeAttenuation),t.map!==void 0&&(this.map=e[t.map]||null),t.matcap!==void 0&&(this.matcap=e[t.matcap]||null),t.alphaMap!==void 0&&(this.alphaMap=e[t.alphaMap]||null),t.bumpMap!==void 0&&(this.bumpMap=e[t.bumpMap]||null),t.bumpScale!==void 0&&(this.bumpScale=t.bumpScale),t.normalMap!==void 0&&(this.normalMap=e[t.normalMap]||null),t.normalMapType!==void 0&&(this.normalMapType=t.normalMapType),t.normalScale!==void 0){let n=t.normalScale;Array.isArray(n)===!1&&(n=[n,n]),this.normalScale=new Bt().fromArray(n)}return t.displacementMap!==void 0&&(this.displacementMap=e[t.displacementMap]||null),t.displacementScale!==void 0&&(this.displacementScale=t.displacementScale),t.displacementBias!==void 0&&(this.displacementBias=t.displacementBias),t.roughnessMap!==void 0&&(this.roughnessMap=e[t.roughnessMap]||null),t.metalnessMap!==void 0&&(this.metalnessMap=e[t.metalnessMap]||null),t.emissiveMap!==void 0&&(this.emissiveMap=e[t.emissiveMap]||null),t.emissiveIntensity!==void 0&&(this.emissiveIntensity=t.emissiveIntensity),t.specularMap!==void 0&&(this.specularMap=e[t.specularMap]||null),t.specularIntensityMap!==void 0&&(this.specularIntensityMap=e[t.specularIntensityMap]||null),t.specularColorMap!==void 0&&(this.specularColorMap=e[t.specularColorMap]||null),t.envMap!==void 0&&(this.envMap=e[t.envMap]||null),t.envMapRotation!==void 0&&this.envMapRotation.fromArray(t.envMapRotation),t.envMapIntensity!==void 0&&(this.envMapIntensity=t.envMapIntensity),t.reflectivity!==void 0&&(this.reflectivity=t.reflectivity),t.refractionRatio!==void 0&&(this.refractionRatio=t.refractionRatio),t.lightMap!==void 0&&(this.lightMap=e[t.lightMap]||null),t.lightMapIntensity!==void 0&&(this.lightMapIntensity=t.lightMapIntensity),t.aoMap!==void 0&&(this.aoMap=e[t.aoMap]||null),t.aoMapIntensity!==void 0&&(this.aoMapIntensity=t.aoMapIntensity),t.gradientMap!==void 0&&(this.gradientMap=e[t.gradientMap]||null),t.clearcoatMap!==void 0&&(this.clearcoatMap=e[t.clearcoatMap]||null),t.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=e[t.clearcoatRoughnessMap]||null),t.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=e[t.clearcoatNormalMap]||null),t.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new Bt().fromArray(t.clearcoatNormalScale)),t.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=e[t.diffuseRoughnessMap]||null),t.iridescenceMap!==void 0&&(this.iridescenceMap=e[t.iridescenceMap]||null),t.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=e[t.iridescenceThicknessMap]||null),t.transmissionMap!==void 0&&(this.transmissionMap=e[t.transmissionMap]||null),t.thicknessMap!==void 0&&(this.thicknessMap=e[t.thicknessMap]||null),t.anisotropyMap!==void 0&&(this.anisotropyMap=e[t.anisotropyMap]||null),t.sheenColorMap!==void 0&&(this.sheenColorMap=e[t.sheenColorMap]||null),t.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=e[t.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(t){this.name=t.name,this.blending=t.blending,this.side=t.side,this.vertexColors=t.vertexColors,this.opacity=t.opacity,this.transparent=t.transparent,this.blendSrc=t.blendSrc,this.blendDst=t.blendDst,this.blendEquation=t.blendEquation,this.blendSrcAlpha=t.blendSrcAlpha,this.blendDstAlpha=t.blendDstAlpha,this.blendEquationAlpha=t.blendEquationAlpha,this.blendColor.copy(t.blendColor),this.blendAlpha=t.blendAlpha,this.depthFunc=t.depthFunc,this.depthTest=t.depthTest,this.depthWrite=t.depthWrite,this.stencilWriteMask=t.stencilWriteMask,this.stencilFunc=t.stencilFunc,this.stencilRef=t.stencilRef,this.stencilFuncMask=t.stencilFuncMask,this.stencilFail=t.stencilFail,this.stencilZFail=t.stencilZFail,this.stencilZPass=t.stencilZPass,this.stencilWrite=t.stencilWrite;let e=t.clippingPlanes,n=null;if(e!==null){let s=e.length;n=new Array(s);for(let r=0;r!==s;++r)n[r]=e[r].clone()}return this.clippingPlanes=n,this.clipIntersection=t.clipIntersection,this.clipShadows=t.clipShadows,this.shadowSide=t.shadowSide,this.colorWrite=t.colorWrite,this.precision=t.precision,this.polygonOffset=t.polygonOffset,this.polygonOffsetFactor=t.polygonOffsetFactor,this.polygonOffsetUnits=t.polygonOffsetUnits,this.dithering=t.dithering,this.alphaTest=t.alphaTest,this.alphaHash=t.alphaHash,this.alphaToCoverage=t.alphaToCoverage,this.premultipliedAlpha=t.premultipliedAlpha,this.forceSinglePass=t.forceSinglePass,this.allowOverride=t.allowOverride,this.visible=t.visible,this.toneMapped=t.toneMapped,this.userData=JSON.parse(JSON.stringify(t.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(t){t===!0&&this.version++}},Oo=class extends Ui{constructor(t){super(),this.isSpriteMaterial=!0,this.type="SpriteMaterial",this.color=new Xt(16777215),this.map=null,this.alphaMap=null,this.rotation=0,this.sizeAttenuation=!0,this.transparent=!0,this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.alphaMap=t.alphaMap,this.rotation=t.rotation,this.sizeAttenuation=t.sizeAttenuation,this.fog=t.fog,this}},go,Sa=new R,_o=new R,xo=new R,yo=new Bt,Ma=new Bt,_g=new Wt,Yl=new R,wa=new R,ql=new R,lm=new Bt,ud=new Bt,cm=new Bt,Va=class extends Ee{constructor(t=new Oo){if(super(),this.isSprite=!0,this.type="Sprite",go===void 0){go=new pe;let e=new Float32Array([-.5,-.5,0,0,0,.5,-.5,0,1,0,.5,.5,0,1,1,-.5,.5,0,0,1]),n=new za(e,5);go.setIndex([0,1,2,0,2,3]),go.setAttribute("position",new Ei(n,3,0,!1)),go.setAttribute("uv",new Ei(n,2,3,!1))}this.geometry=go,this.material=t,this.center=new Bt(.5,.5),this.count=1}intersectsFrustum(t){return t.intersectsSprite(this)}raycast(t,e){t.camera===null&&te('Sprite: "Raycaster.camera" needs to be set in order to raycast against sprites.'),_o.setFromMatrixScale(this.matrixWorld),_g.copy(t.camera.matrixWorld),this.modelViewMatrix.multiplyMatrices(t.camera.matrixWorldInverse,this.matrixWorld),xo.setFromMatrixPosition(this.modelViewMatrix),t.camera.isPerspectiveCamera&&this.material.sizeAttenuation===!1&&_o.multiplyScalar(-xo.z);let n=this.material.rotation,s,r;n!==0&&(r=Math.cos(n),s=Math.sin(n));let o=this.center;$l(Yl.set(-.5,-.5,0),xo,o,_o,s,r),$l(wa.set(.5,-.5,0),xo,o,_o,s,r),$l(ql.set(.5,.5,0),xo,o,_o,s,r),lm.set(0,0),ud.set(1,0),cm.set(1,1);let a=t.ray.intersectTriangle(Yl,wa,ql,!1,Sa);if(a===null&&($l(wa.set(-.5,.5,0),xo,o,_o,s,r),ud.set(0,1),a=t.ray.intersectTriangle(Yl,ql,wa,!1,Sa),a===null))return;let l=t.ray.origin.distanceTo(Sa);l<t.near||l>t.far||e.push({distance:l,point:Sa.clone(),uv:Is.getInterpolation(Sa,Yl,wa,ql,lm,ud,cm,new Bt),face:null,object:this})}copy(t,e){return super.copy(t,e),t.center!==void 0&&this.center.copy(t.center),this.material=t.material,this}toJSON(t){let e=super.toJSON(t);return e.object.center=this.center.toArray(),e}};function $l(i,t,e,n,s,r){yo.subVectors(i,e).addScalar(.5).multiply(n),s!==void 0?(Ma.x=r*yo.x-s*yo.y,Ma.y=s*yo.x+r*yo.y):Ma.copy(yo),i.copy(t),i.x+=Ma.x,i.y+=Ma.y,i.applyMatrix4(_g)}var Ps=new R,dd=new R,Zl=new R,Jl=new R,Ns=class{constructor(t=new R,e=new R(0,0,-1)){this.origin=t,this.direction=e}set(t,e){return this.origin.copy(t),this.direction.copy(e),this}copy(t){return this.origin.copy(t.origin),this.direction.copy(t.direction),this}at(t,e){return e.copy(this.origin).addScaledVector(this.direction,t)}lookAt(t){return this.direction.copy(t).sub(this.origin).normalize(),this}recast(t){return this.origin.copy(this.at(t,Ps)),this}closestPointToPoint(t,e){e.subVectors(t,this.origin);let n=e.dot(this.direction);return n<0?e.copy(this.origin):e.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(t){return Math.sqrt(this.distanceSqToPoint(t))}distanceSqToPoint(t){let e=Ps.subVectors(t,this.origin).dot(this.direction);return e<0?this.origin.distanceToSquared(t):(Ps.copy(this.origin).addScaledVector(this.direction,e),Ps.distanceToSquared(t))}distanceSqToSegment(t,e,n,s){dd.copy(t).add(e).multiplyScalar(.5),Zl.copy(e).sub(t).normalize(),Jl.copy(this.origin).sub(dd);let r=t.distanceTo(e)*.5,o=-this.direction.dot(Zl),a=Jl.dot(this.direction),l=-Jl.dot(Zl),c=Jl.lengthSq(),d=Math.abs(1-o*o),h,u,f,p;if(d>0)if(h=o*l-a,u=o*a-l,p=r*d,h>=0)if(u>=-p)if(u<=p){let _=1/d;h*=_,u*=_,f=h*(h+o*u+2*a)+u*(o*h+u+2*l)+c}else u=r,h=Math.max(0,-(o*u+a)),f=-h*h+u*(u+2*l)+c;else u=-r,h=Math.max(0,-(o*u+a)),f=-h*h+u*(u+2*l)+c;else u<=-p?(h=Math.max(0,-(-o*r+a)),u=h>0?-r:Math.min(Math.max(-r,-l),r),f=-h*h+u*(u+2*l)+c):u<=p?(h=0,u=Math.min(Math.max(-r,-l),r),f=u*(u+2*l)+c):(h=Math.max(0,-(o*r+a)),u=h>0?r:Math.min(Math.max(-r,-l),r),f=-h*h+u*(u+2*l)+c);else u=o>0?-r:r,h=Math.max(0,-(o*u+a)),f=-h*h+u*(u+2*l)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,h),s&&s.copy(dd).addScaledVector(Zl,u),f}intersectSphere(t,e){if(t.radius<0)return null;Ps.subVectors(t.center,this.origin);let n=Ps.dot(this.direction),s=Ps.dot(Ps)-n*n,r=t.radius*t.radius;if(s>r)return null;let o=Math.sqrt(r-s),a=n-o,l=n+o;return l<0?null:a<0?this.at(l,e):this.at(a,e)}intersectsSphere(t){return t.radius<0?!1:this.distanceSqToPoint(t.center)<=t.radius*t.radius}distanceToPlane(t){let e=t.normal.dot(this.direction);if(e===0)return t.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(t.normal)+t.constant)/e;return n>=0?n:null}intersectPlane(t,e){let n=this.distanceToPlane(t);return n===null?null:this.at(n,e)}intersectsPlane(t){let e=t.distanceToPoint(this.origin);return e===0||t.normal.dot(this.direction)*e<0}intersectBox(t,e){let n,s,r,o,a,l,c=1/this.direction.x,d=1/this.direction.y,h=1/this.direction.z,u=this.origin;return c>=0?(n=(t.min.x-u.x)*c,s=(t.max.x-u.x)*c):(n=(t.max.x-u.x)*c,s=(t.min.x-u.x)*c),d>=0?(r=(t.min.y-u.y)*d,o=(t.max.y-u.y)*d):(r=(t.max.y-u.y)*d,o=(t.min.y-u.y)*d),n>o||r>s||((r>n||isNaN(n))&&(n=r),(o<s||isNaN(s))&&(s=o),h>=0?(a=(t.min.z-u.z)*h,l=(t.max.z-u.z)*h):(a=(t.max.z-u.z)*h,l=(t.min.z-u.z)*h),n>l||a>s)||((a>n||n!==n)&&(n=a),(l<s||s!==s)&&(s=l),s<0)?null:this.at(n>=0?n:s,e)}intersectsBox(t){return this.intersectBox(t,Ps)!==null}intersectTriangle(t,e,n,s,r){let o=this.origin,a=this.direction,l=a.x,c=a.y,d=a.z,h=t.x-o.x,u=t.y-o.y,f=t.z-o.z,p=e.x-o.x,_=e.y-o.y,m=e.z-o.z,g=n.x-o.x,y=n.y-o.y,T=n.z-o.z,v=Math.abs(l),M=Math.abs(c),b=Math.abs(d),x,w,O,P,L,B,G,D,X,Z,W,at;if(v>=M&&v>=b?(O=l,B=h,X=p,at=g,l>=0?(x=c,w=d,P=u,L=f,G=_,D=m,Z=y,W=T):(x=d,w=c,P=f,L=u,G=m,D=_,Z=T,W=y)):M>=b?(O=c,B=u,X=_,at=y,c>=0?(x=d,w=l,P=f,L=h,G=m,D=p,Z=T,W=g):(x=l,w=d,P=h,L=f,G=p,D=m,Z=g,W=T)):(O=d,B=f,X=m,at=T,d>=0?(x=l,w=c,P=h,L=u,G=p,D=_,Z=g,W=y):(x=c,w=l,P=u,L=h,G=_,D=p,Z=y,W=g)),O===0)return null;let k=x/O,q=w/O,Q=1/O,lt=P-k*B,ht=L-q*B,et=G-k*X,mt=D-q*X,xt=Z-k*at,Ct=W-q*at,wt=xt*mt-Ct*et,$t=lt*Ct-ht*xt,le=et*ht-mt*lt;if(s){if(wt<0||$t<0||le<0)return null}else if((wt<0||$t<0||le<0)&&(wt>0||$t>0||le>0))return null;let Yt=wt+$t+le;if(Yt===0)return null;let ge=Q*(wt*B+$t*X+le*at);return(Yt>0?ge<0:ge>0)?null:this.at(ge/Yt,r)}applyMatrix4(t){return this.origin.applyMatrix4(t),this.direction.transformDirection(t),this}equals(t){return t.origin.equals(this.origin)&&t.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},Vn=class extends Ui{constructor(t){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new Xt(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Qn,this.combine=qc,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.lightMap=t.lightMap,this.lightMapIntensity=t.lightMapIntensity,this.aoMap=t.aoMap,this.aoMapIntensity=t.aoMapIntensity,this.specularMap=t.specularMap,this.alphaMap=t.alphaMap,this.envMap=t.envMap,this.envMapRotation.copy(t.envMapRotation),this.combine=t.combine,this.reflectivity=t.reflectivity,this.refractionRatio=t.refractionRatio,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.wireframeLinecap=t.wireframeLinecap,this.wireframeLinejoin=t.wireframeLinejoin,this.fog=t.fog,this}},hm=new Wt,br=new Ns,jl=new mi,um=new R,Kl=new R,Ql=new R,tc=new R,fd=new R,ec=new R,dm=new R,nc=new R,St=class extends Ee{constructor(t=new pe,e=new Vn){super(),this.isMesh=!0,this.type="Mesh",this.geometry=t,this.material=e,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(t,e){return super.copy(t,e),t.morphTargetInfluences!==void 0?this.morphTargetInfluences=t.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,t.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},t.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(t.material)?t.material.slice():t.material,this.geometry=t.geometry,this}updateMorphTargets(){let e=this.geometry.morphAttributes,n=Object.keys(e);if(n.length>0){let s=e[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}getVertexPosition(t,e){let n=this.geometry,s=n.attributes.position,r=n.morphAttributes.position,o=n.morphTargetsRelative;e.fromBufferAttribute(s,t);let a=this.morphTargetInfluences;if(r&&a){ec.set(0,0,0);for(let l=0,c=r.length;l<c;l++){let d=a[l],h=r[l];d!==0&&(fd.fromBufferAttribute(h,t),o?ec.addScaledVector(fd,d):ec.addScaledVector(fd.sub(e),d))}e.add(ec)}return e}intersectsFrustum(t){return t.intersectsObject(this)}raycast(t,e){let n=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),jl.copy(n.boundingSphere),jl.applyMatrix4(r),br.copy(t.ray).recast(t.near),!(jl.containsPoint(br.origin)===!1&&(br.intersectSphere(jl,um)===null||br.origin.distanceToSquared(um)>(t.far-t.near)**2))&&(hm.copy(r).invert(),br.copy(t.ray).applyMatrix4(hm),!(n.boundingBox!==null&&br.intersectsBox(n.boundingBox)===!1)&&this._computeIntersections(t,e,br)))}_computeIntersections(t,e,n){let s,r=this.geometry,o=this.material,a=r.index,l=r.attributes.position,c=r.attributes.uv,d=r.attributes.uv1,h=r.attributes.normal,u=r.groups,f=r.drawRange;if(a!==null)if(Array.isArray(o))for(let p=0,_=u.length;p<_;p++){let m=u[p],g=o[m.materialIndex],y=Math.max(m.start,f.start),T=Math.min(a.count,Math.min(m.start+m.count,f.start+f.count));for(let v=y,M=T;v<M;v+=3){let b=a.getX(v),x=a.getX(v+1),w=a.getX(v+2);s=ic(this,g,t,n,c,d,h,b,x,w),s&&(s.faceIndex=Math.floor(v/3),s.face.materialIndex=m.materialIndex,e.push(s))}}else{let p=Math.max(0,f.start),_=Math.min(a.count,f.start+f.count);for(let m=p,g=_;m<g;m+=3){let y=a.getX(m),T=a.getX(m+1),v=a.getX(m+2);s=ic(this,o,t,n,c,d,h,y,T,v),s&&(s.faceIndex=Math.floor(m/3),e.push(s))}}else if(l!==void 0)if(Array.isArray(o))for(let p=0,_=u.length;p<_;p++){let m=u[p],g=o[m.materialIndex],y=Math.max(m.start,f.start),T=Math.min(l.count,Math.min(m.start+m.count,f.start+f.count));for(let v=y,M=T;v<M;v+=3){let b=v,x=v+1,w=v+2;s=ic(this,g,t,n,c,d,h,b,x,w),s&&(s.faceIndex=Math.floor(v/3),s.face.materialIndex=m.materialIndex,e.push(s))}}else{let p=Math.max(0,f.start),_=Math.min(l.count,f.start+f.count);for(let m=p,g=_;m<g;m+=3){let y=m,T=m+1,v=m+2;s=ic(this,o,t,n,c,d,h,y,T,v),s&&(s.faceIndex=Math.floor(m/3),e.push(s))}}}};function Uy(i,t,e,n,s,r,o,a){let l;if(t.side===Yn?l=n.intersectTriangle(o,r,s,!0,a):l=n.intersectTriangle(s,r,o,t.side===dr,a),l===null)return null;nc.copy(a),nc.applyMatrix4(i.matrixWorld);let c=e.ray.origin.distanceTo(nc);return c<e.near||c>e.far?null:{distance:c,point:nc.clone(),object:i}}function ic(i,t,e,n,s,r,o,a,l,c){i.getVertexPosition(a,Kl),i.getVertexPosition(l,Ql),i.getVertexPosition(c,tc);let d=Uy(i,t,e,n,Kl,Ql,tc,dm);if(d){let h=new R;Is.getBarycoord(dm,Kl,Ql,tc,h),s&&(d.uv=Is.getInterpolatedAttribute(s,a,l,c,h,new Bt)),r&&(d.uv1=Is.getInterpolatedAttribute(r,a,l,c,h,new Bt)),o&&(d.normal=Is.getInterpolatedAttribute(o,a,l,c,h,new R),d.normal.dot(n.direction)>0&&d.normal.multiplyScalar(-1));let u={a,b:l,c,normal:new R,materialIndex:0};Is.getNormal(Kl,Ql,tc,u.normal),d.face=u,d.barycoord=h}return d}var Ar=class extends Wn{constructor(t=null,e=1,n=1,s,r,o,a,l,c=zn,d=zn,h,u){super(null,o,a,l,c,d,s,r,h,u),this.isDataTexture=!0,this.image={data:t,width:e,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var Cr=class extends Le{constructor(t,e,n,s=1){super(t,e,n),this.isInstancedBufferAttribute=!0,this.meshPerAttribute=s}copy(t){return super.copy(t),this.meshPerAttribute=t.meshPerAttribute,this}toJSON(){let t=super.toJSON();return t.meshPerAttribute=this.meshPerAttribute,t.isInstancedBufferAttribute=!0,t}},vo=new Wt,fm=new Wt,sc=[],pm=new en,Fy=new Wt,ba=new St,Ta=new mi,Os=class extends St{constructor(t,e,n){super(t,e),this.isInstancedMesh=!0,this.instanceMatrix=new Cr(new Float32Array(n*16),16),this.instanceColor=null,this.morphTexture=null,this.count=n,this.boundingBox=null,this.boundingSphere=null;for(let s=0;s<n;s++)this.setMatrixAt(s,Fy)}computeBoundingBox(){let t=this.geometry,e=this.count;this.boundingBox===null&&(this.boundingBox=new en),t.boundingBox===null&&t.computeBoundingBox(),this.boundingBox.makeEmpty();for(let n=0;n<e;n++)this.getMatrixAt(n,vo),pm.copy(t.boundingBox).applyMatrix4(vo),this.boundingBox.union(pm)}computeBoundingSphere(){let t=this.geometry,e=this.count;this.boundingSphere===null&&(this.boundingSphere=new mi),t.boundingSphere===null&&t.computeBoundingSphere(),this.boundingSphere.makeEmpty();for(let n=0;n<e;n++)this.getMatrixAt(n,vo),Ta.copy(t.boundingSphere).applyMatrix4(vo),this.boundingSphere.union(Ta)}copy(t,e){return super.copy(t,e),this.instanceMatrix.copy(t.instanceMatrix),this.morphTexture=t.morphTexture!==null?t.morphTexture.clone():null,this.instanceColor=t.instanceColor!==null?t.instanceColor.clone():null,this.count=t.count,this.boundingBox=t.boundingBox!==null?t.boundingBox.clone():null,this.boundingSphere=t.boundingSphere!==null?t.boundingSphere.clone():null,this}getColorAt(t,e){return this.instanceColor===null?e.setRGB(1,1,1):e.fromArray(this.instanceColor.array,t*3)}getMatrixAt(t,e){return e.fromArray(this.instanceMatrix.array,t*16)}getMorphAt(t,e){let n=e.morphTargetInfluences,s=this.morphTexture.source.data.data,r=n.length+1,o=t*r+1;for(let a=0;a<n.length;a++)n[a]=s[o+a]}raycast(t,e){let n=this.matrixWorld,s=this.count;if(ba.geometry=this.geometry,ba.material=this.material,ba.material!==void 0&&(this.boundingSphere===null&&this.computeBoundingSphere(),Ta.copy(this.boundingSphere),Ta.applyMatrix4(n),t.ray.intersectsSphere(Ta)!==!1))for(let r=0;r<s;r++){this.getMatrixAt(r,vo),fm.multiplyMatrices(n,vo),ba.matrixWorld=fm,ba.raycast(t,sc);for(let o=0,a=sc.length;o<a;o++){let l=sc[o];l.instanceId=r,l.object=this,e.push(l)}sc.length=0}}setColorAt(t,e){return this.instanceColor===null&&(this.instanceColor=new Cr(new Float32Array(this.instanceMatrix.count*3).fill(1),3)),e.toArray(this.instanceColor.array,t*3),this}setMatrixAt(t,e){return e.toArray(this.instanceMatrix.array,t*16),this}setMorphAt(t,e){let n=e.morphTargetInfluences,s=n.length+1;this.morphTexture===null&&(this.morphTexture=new Ar(new Float32Array(s*this.count),s,this.count,th,Fi));let r=this.morphTexture.source.data.data,o=0;for(let c=0;c<n.length;c++)o+=n[c];let a=this.geometry.morphTargetsRelative?1:1-o,l=s*t;return r[l]=a,r.set(n,l+1),this}updateMorphTargets(){}dispose(){super.dispose(),this.instanceMatrix.dispose(),this.instanceColor!==null&&this.instanceColor.dispose(),this.morphTexture!==null&&(this.morphTexture.dispose(),this.morphTexture=null)}},Tr=new mi,By=new Bt(.5,.5),rc=new R,nr=class{constructor(t=new En,e=new En,n=new En,s=new En,r=new En,o=new En){this.planes=[t,e,n,s,r,o]}set(t,e,n,s,r,o){let a=this.planes;return a[0].copy(t),a[1].copy(e),a[2].copy(n),a[3].copy(s),a[4].copy(r),a[5].copy(o),this}copy(t){let e=this.planes;for(let n=0;n<6;n++)e[n].copy(t.planes[n]);return this}setFromProjectionMatrix(t,e=Oi,n=!1){let s=this.planes,r=t.elements,o=r[0],a=r[1],l=r[2],c=r[3],d=r[4],h=r[5],u=r[6],f=r[7],p=r[8],_=r[9],m=r[10],g=r[11],y=r[12],T=r[13],v=r[14],M=r[15];if(s[0].setComponents(c-o,f-d,g-p,M-y).normalize(),s[1].setComponents(c+o,f+d,g+p,M+y).normalize(),s[2].setComponents(c+a,f+h,g+_,M+T).normalize(),s[3].setComponents(c-a,f-h,g-_,M-T).normalize(),n)s[4].setComponents(l,u,m,v).normalize(),s[5].setComponents(c-l,f-u,g-m,M-v).normalize();else if(s[4].setComponents(c-l,f-u,g-m,M-v).normalize(),e===Oi)s[5].setComponents(c+l,f+u,g+m,M+v).normalize();else if(e===Ro)s[5].setComponents(l,u,m,v).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+e);return this}intersectsObject(t){if(t.boundingSphere!==void 0)t.boundingSphere===null&&t.computeBoundingSphere(),Tr.copy(t.boundingSphere).applyMatrix4(t.matrixWorld);else{let e=t.geometry;e.boundingSphere===null&&e.computeBoundingSphere(),Tr.copy(e.boundingSphere).applyMatrix4(t.matrixWorld)}return this.intersectsSphere(Tr)}intersectsSprite(t){Tr.center.set(0,0,0);let e=By.distanceTo(t.center);return Tr.radius=.7071067811865476+e,Tr.applyMatrix4(t.matrixWorld),this.intersectsSphere(Tr)}intersectsSphere(t){let e=this.planes,n=t.center,s=-t.radius;for(let r=0;r<6;r++)if(e[r].distanceToPoint(n)<s)return!1;return!0}intersectsBox(t){let e=this.planes;for(let n=0;n<6;n++){let s=e[n];if(rc.x=s.normal.x>0?t.max.x:t.min.x,rc.y=s.normal.y>0?t.max.y:t.min.y,rc.z=s.normal.z>0?t.max.z:t.min.z,s.distanceToPoint(rc)<0)return!1}return!0}containsPoint(t){let e=this.planes;for(let n=0;n<6;n++)if(e[n].distanceToPoint(t)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},mm=new Wt,Rc=class i{constructor(){this.coordinateSystem=Oi,this._frustums=[],this._count=0}setFromArrayCamera(t){let e=t.cameras,n=this._frustums;for(let s=0;s<e.length;s++){let r=e[s];mm.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[s]===void 0&&(n[s]=new nr),n[s].setFromProjectionMatrix(mm,r.coordinateSystem,r.reversedDepth)}return this._count=e.length,this}getFrustum(t){return this._frustums[t]}intersectsObject(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsObject(t))return!0;return!1}intersectsSprite(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsSprite(t))return!0;return!1}intersectsSphere(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsSphere(t))return!0;return!1}intersectsBox(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsBox(t))return!0;return!1}containsPoint(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].containsPoint(t))return!0;return!1}copy(t){this.coordinateSystem=t.coordinateSystem;let e=this._frustums,n=t._frustums;for(let s=0;s<t._count;s++)e[s]===void 0&&(e[s]=new nr),e[s].copy(n[s]);return this._count=t._count,this}clone(){return new i().copy(this)}};var Ai=class extends Ui{constructor(t){super(),this.isLineBasicMaterial=!0,this.type="LineBasicMaterial",this.color=new Xt(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.linewidth=t.linewidth,this.linecap=t.linecap,this.linejoin=t.linejoin,this.fog=t.fog,this}},Pc=new R,Ic=new R,gm=new Wt,Ea=new Ns,oc=new mi,pd=new R,_m=new R,ti=class extends Ee{constructor(t=new pe,e=new Ai){super(),this.isLine=!0,this.type="Line",this.geometry=t,this.material=e,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(t,e){return super.copy(t,e),t.morphTargetInfluences!==void 0?this.morphTargetInfluences=t.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,t.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},t.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(t.material)?t.material.slice():t.material,this.geometry=t.geometry,this}computeLineDistances(){let t=this.geometry;if(t.index===null){let e=t.attributes.position,n=[0];for(let s=1,r=e.count;s<r;s++)Pc.fromBufferAttribute(e,s-1),Ic.fromBufferAttribute(e,s),n[s]=n[s-1],n[s]+=Pc.distanceTo(Ic);t.setAttribute("lineDistance",new ie(n,1))}else jt("Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}intersectsFrustum(t){return t.intersectsObject(this)}raycast(t,e){let n=this.geometry,s=this.matrixWorld,r=t.params.Line.threshold,o=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),oc.copy(n.boundingSphere),oc.applyMatrix4(s),oc.radius+=r,t.ray.intersectsSphere(oc)===!1)return;gm.copy(s).invert(),Ea.copy(t.ray).applyMatrix4(gm);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=this.isLineSegments?2:1,d=n.index,u=n.attributes.position;if(d!==null){let f=Math.max(0,o.start),p=Math.min(d.count,o.start+o.count);for(let _=f,m=p-1;_<m;_+=c){let g=d.getX(_),y=d.getX(_+1),T=ac(this,t,Ea,l,g,y,_);T&&e.push(T)}if(this.isLineLoop){let _=d.getX(p-1),m=d.getX(f),g=ac(this,t,Ea,l,_,m,p-1);g&&e.push(g)}}else{let f=Math.max(0,o.start),p=Math.min(u.count,o.start+o.count);for(let _=f,m=p-1;_<m;_+=c){let g=ac(this,t,Ea,l,_,_+1,_);g&&e.push(g)}if(this.isLineLoop){let _=ac(this,t,Ea,l,p-1,f,p-1);_&&e.push(_)}}}updateMorphTargets(){let e=this.geometry.morphAttributes,n=Object.keys(e);if(n.length>0){let s=e[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function ac(i,t,e,n,s,r,o){let a=i.geometry.attributes.position;if(Pc.fromBufferAttribute(a,s),Ic.fromBufferAttribute(a,r),e.distanceSqToSegment(Pc,Ic,pd,_m)>n)return;pd.applyMatrix4(i.matrixWorld);let c=t.ray.origin.distanceTo(pd);if(!(c<t.near||c>t.far))return{distance:c,point:_m.clone().applyMatrix4(i.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:i}}var xm=new R,ym=new R,ir=class extends ti{constructor(t,e){super(t,e),this.isLineSegments=!0,this.type="LineSegments"}computeLineDistances(){let t=this.geometry;if(t.index===null){let e=t.attributes.position,n=[];for(let s=0,r=e.count;s<r;s+=2)xm.fromBufferAttribute(e,s),ym.fromBufferAttribute(e,s+1),n[s]=s===0?0:n[s-1],n[s+1]=n[s]+xm.distanceTo(ym);t.setAttribute("lineDistance",new ie(n,1))}else jt("LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}};var Us=class extends Ui{constructor(t){super(),this.isPointsMaterial=!0,this.type="PointsMaterial",this.color=new Xt(16777215),this.map=null,this.alphaMap=null,this.size=1,this.sizeAttenuation=!0,this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.alphaMap=t.alphaMap,this.size=t.size,this.sizeAttenuation=t.sizeAttenuation,this.fog=t.fog,this}},vm=new Wt,Md=new Ns,lc=new mi,cc=new R,sr=class extends Ee{constructor(t=new pe,e=new Us){super(),this.isPoints=!0,this.type="Points",this.geometry=t,this.material=e,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(t,e){return super.copy(t,e),t.morphTargetInfluences!==void 0?this.morphTargetInfluences=t.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,t.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},t.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(t.material)?t.material.slice():t.material,this.geometry=t.geometry,this}intersectsFrustum(t){return t.intersectsObject(this)}raycast(t,e){let n=this.geometry,s=this.matrixWorld,r=t.params.Points.threshold,o=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),lc.copy(n.boundingSphere),lc.applyMatrix4(s),lc.radius+=r,t.ray.intersectsSphere(lc)===!1)return;vm.copy(s).invert(),Md.copy(t.ray).applyMatrix4(vm);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=n.index,h=n.attributes.position;if(c!==null){let u=Math.max(0,o.start),f=Math.min(c.count,o.start+o.count);for(let p=u,_=f;p<_;p++){let m=c.getX(p);cc.fromBufferAttribute(h,m),Sm(cc,m,l,s,t,e,this)}}else{let u=Math.max(0,o.start),f=Math.min(h.count,o.start+o.count);for(let p=u,_=f;p<_;p++)cc.fromBufferAttribute(h,p),Sm(cc,p,l,s,t,e,this)}}updateMorphTargets(){let e=this.geometry.morphAttributes,n=Object.keys(e);if(n.length>0){let s=e[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function Sm(i,t,e,n,s,r,o){let a=Md.distanceSqToPoint(i);if(a<e){let l=new R;Md.closestPointToPoint(i,l),l.applyMatrix4(n);let c=s.ray.origin.distanceTo(l);if(c<s.near||c>s.far)return;r.push({distance:c,distanceToRay:Math.sqrt(a),point:l,index:t,face:null,faceIndex:null,barycoord:null,object:o})}}var Ga=class extends Wn{constructor(t=[],e=Nr,n,s,r,o,a,l,c,d){super(t,e,n,s,r,o,a,l,c,d),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(t){this.image=t}},Ha=class extends Wn{constructor(t,e,n,s,r,o,a,l,c){super(t,e,n,s,r,o,a,l,c),this.isCanvasTexture=!0,this.needsUpdate=!0}};var Fs=class extends Wn{constructor(t,e,n=Zi,s,r,o,a=zn,l=zn,c,d=Ds,h=1){if(d!==Ds&&d!==zs)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let u={width:t,height:e,depth:h};super(u,s,r,o,a,l,d,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(t){return super.copy(t),this.source=new Io(Object.assign({},t.image)),this.compareFunction=t.compareFunction,this}toJSON(t){let e=super.toJSON(t);return e.compareFunction=this.compareFunction,e}},Wa=class extends Fs{constructor(t,e=Zi,n=Nr,s,r,o=zn,a=zn,l,c=Ds){let d={width:t,height:t,depth:1},h=[d,d,d,d,d,d];super(t,t,e,n,s,r,o,a,l,c),this.image=h,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(t){this.image=t}},Xa=class extends Wn{constructor(t=null){super(),this.sourceTexture=t,this.isExternalTexture=!0}copy(t){return super.copy(t),this.sourceTexture=t.sourceTexture,this}},Ye=class i extends pe{constructor(t=1,e=1,n=1,s=1,r=1,o=1){super(),this.type="BoxGeometry",this.parameters={width:t,height:e,depth:n,widthSegments:s,heightSegments:r,depthSegments:o};let a=this;s=Math.floor(s),r=Math.floor(r),o=Math.floor(o);let l=[],c=[],d=[],h=[],u=0,f=0;p("z","y","x",-1,-1,n,e,t,o,r,0),p("z","y","x",1,-1,n,e,-t,o,r,1),p("x","z","y",1,1,t,n,e,s,o,2),p("x","z","y",1,-1,t,n,-e,s,o,3),p("x","y","z",1,-1,t,e,n,s,r,4),p("x","y","z",-1,-1,t,e,-n,s,r,5),this.setIndex(l),this.setAttribute("position",new ie(c,3)),this.setAttribute("normal",new ie(d,3)),this.setAttribute("uv",new ie(h,2));function p(_,m,g,y,T,v,M,b,x,w,O){let P=v/x,L=M/w,B=v/2,G=M/2,D=b/2,X=x+1,Z=w+1,W=0,at=0,k=new R;for(let q=0;q<Z;q++){let Q=q*L-G;for(let lt=0;lt<X;lt++){let ht=lt*P-B;k[_]=ht*y,k[m]=Q*T,k[g]=D,c.push(k.x,k.y,k.z),k[_]=0,k[m]=0,k[g]=b>0?1:-1,d.push(k.x,k.y,k.z),h.push(lt/x),h.push(1-q/w),W+=1}}for(let q=0;q<w;q++)for(let Q=0;Q<x;Q++){let lt=u+Q+X*q,ht=u+Q+X*(q+1),et=u+(Q+1)+X*(q+1),mt=u+(Q+1)+X*q;l.push(lt,ht,mt),l.push(ht,et,mt),at+=6}a.addGroup(f,at,O),f+=at,u+=W}}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.width,t.height,t.depth,t.widthSegments,t.heightSegments,t.depthSegments)}},Ya=class i extends pe{constructor(t=1,e=1,n=4,s=8,r=1){super(),this.type="CapsuleGeometry",this.parameters={radius:t,height:e,capSegments:n,radialSegments:s,heightSegments:r},e=Math.max(0,e),n=Math.max(1,Math.floor(n)),s=Math.max(3,Math.floor(s)),r=Math.max(1,Math.floor(r));let o=[],a=[],l=[],c=[],d=e/2,h=Math.PI/2*t,u=e,f=2*h+u,p=n*2+r,_=s+1,m=new R,g=new R;for(let y=0;y<=p;y++){let T=0,v=0,M=0,b=0;if(y<=n){let O=y/n,P=O*Math.PI/2;v=-d-t*Math.cos(P),M=t*Math.sin(P),b=-t*Math.cos(P),T=O*h}else if(y<=n+r){let O=(y-n)/r;v=-d+O*e,M=t,b=0,T=h+O*u}else{let O=(y-n-r)/n,P=O*Math.PI/2;v=d+t*Math.sin(P),M=t*Math.cos(P),b=t*Math.sin(P),T=h+u+O*h}let x=Math.max(0,Math.min(1,T/f)),w=0;y===0?w=.5/s:y===p&&(w=-.5/s);for(let O=0;O<=s;O++){let P=O/s,L=P*Math.PI*2,B=Math.sin(L),G=Math.cos(L);g.x=-M*G,g.y=v,g.z=M*B,a.push(g.x,g.y,g.z),m.set(-M*G,b,M*B),m.normalize(),l.push(m.x,m.y,m.z),c.push(P+w,x)}if(y>0){let O=(y-1)*_;for(let P=0;P<s;P++){let L=O+P,B=O+P+1,G=y*_+P,D=y*_+P+1;o.push(L,B,G),o.push(B,D,G)}}}this.setIndex(o),this.setAttribute("position",new ie(a,3)),this.setAttribute("normal",new ie(l,3)),this.setAttribute("uv",new ie(c,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.radius,t.height,t.capSegments,t.radialSegments,t.heightSegments)}},qa=class i extends pe{constructor(t=1,e=32,n=0,s=Math.PI*2){super(),this.type="CircleGeometry",this.parameters={radius:t,segments:e,thetaStart:n,thetaLength:s},e=Math.max(3,e);let r=[],o=[],a=[],l=[],c=new R,d=new Bt;o.push(0,0,0),a.push(0,0,1),l.push(.5,.5);for(let h=0,u=3;h<=e;h++,u+=3){let f=n+h/e*s;c.x=t*Math.cos(f),c.y=t*Math.sin(f),o.push(c.x,c.y,c.z),a.push(0,0,1),d.x=(o[u]/t+1)/2,d.y=(o[u+1]/t+1)/2,l.push(d.x,d.y)}for(let h=1;h<=e;h++)r.push(h,h+1,0);this.setIndex(r),this.setAttribute("position",new ie(o,3)),this.setAttribute("normal",new ie(a,3)),this.setAttribute("uv",new ie(l,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.radius,t.segments,t.thetaStart,t.thetaLength)}},rn=class i extends pe{constructor(t=1,e=1,n=1,s=32,r=1,o=!1,a=0,l=Math.PI*2){super(),this.type="CylinderGeometry",this.parameters={radiusTop:t,radiusBottom:e,height:n,radialSegments:s,heightSegments:r,openEnded:o,thetaStart:a,thetaLength:l};let c=this;s=Math.floor(s),r=Math.floor(r);let d=[],h=[],u=[],f=[],p=0,_=[],m=n/2,g=0;y(),o===!1&&(t>0&&T(!0),e>0&&T(!1)),this.setIndex(d),this.setAttribute("position",new ie(h,3)),this.setAttribute("normal",new ie(u,3)),this.setAttribute("uv",new ie(f,2));function y(){let v=new R,M=new R,b=0,x=(e-t)/n;for(let w=0;w<=r;w++){let O=[],P=w/r,L=P*(e-t)+t;for(let B=0;B<=s;B++){let G=B/s,D=G*l+a,X=Math.sin(D),Z=Math.cos(D);M.x=L*X,M.y=-P*n+m,M.z=L*Z,h.push(M.x,M.y,M.z),v.set(X,x,Z).normalize(),u.push(v.x,v.y,v.z),f.push(G,1-P),O.push(p++)}_.push(O)}for(let w=0;w<s;w++)for(let O=0;O<r;O++){let P=_[O][w],L=_[O+1][w],B=_[O+1][w+1],G=_[O][w+1];(t>0||O!==0)&&(d.push(P,L,G),b+=3),(e>0||O!==r-1)&&(d.push(L,B,G),b+=3)}c.addGroup(g,b,0),g+=b}function T(v){let M=p,b=new Bt,x=new R,w=0,O=v===!0?t:e,P=v===!0?1:-1;for(let B=1;B<=s;B++)h.push(0,m*P,0),u.push(0,P,0),f.push(.5,.5),p++;let L=p;for(let B=0;B<=s;B++){let D=B/s*l+a,X=Math.cos(D),Z=Math.sin(D);x.x=O*Z,x.y=m*P,x.z=O*X,h.push(x.x,x.y,x.z),u.push(0,P,0),b.x=X*.5+.5,b.y=Z*.5*P+.5,f.push(b.x,b.y),p++}for(let B=0;B<s;B++){let G=M+B,D=L+B;v===!0?d.push(D,D+1,G):d.push(D+1,D,G),w+=3}c.addGroup(g,w,v===!0?1:2),g+=w}}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.radiusTop,t.radiusBottom,t.height,t.radialSegments,t.heightSegments,t.openEnded,t.thetaStart,t.thetaLength)}},Uo=class i extends rn{constructor(t=1,e=1,n=32,s=1,r=!1,o=0,a=Math.PI*2){super(0,t,e,n,s,r,o,a),this.type="ConeGeometry",this.parameters={radius:t,height:e,radialSegments:n,heightSegments:s,openEnded:r,thetaStart:o,thetaLength:a}}static fromJSON(t){return new i(t.radius,t.height,t.radialSegments,t.heightSegments,t.openEnded,t.thetaStart,t.thetaLength)}},Lc=class i extends pe{constructor(t=[],e=[],n=1,s=0){super(),this.type="PolyhedronGeometry",this.parameters={vertices:t,indices:e,radius:n,detail:s};let r=[],o=[];a(s),c(n),d(),this.setAttribute("position",new ie(r,3)),this.setAttribute("normal",new ie(r.slice(),3)),this.setAttribute("uv",new ie(o,2)),s===0?this.computeVertexNormals():this.normalizeNormals();function a(y){let T=new R,v=new R,M=new R;for(let b=0;b<e.length;b+=3)f(e[b+0],T),f(e[b+1],v),f(e[b+2],M),l(T,v,M,y)}function l(y,T,v,M){let b=M+1,x=[];for(let w=0;w<=b;w++){x[w]=[];let O=y.clone().lerp(v,w/b),P=T.clone().lerp(v,w/b),L=b-w;for(let B=0;B<=L;B++)B===0&&w===b?x[w][B]=O:x[w][B]=O.clone().lerp(P,B/L)}for(let w=0;w<b;w++)for(let O=0;O<2*(b-w)-1;O++){let P=Math.floor(O/2);O%2===0?(u(x[w][P+1]),u(x[w+1][P]),u(x[w][P])):(u(x[w][P+1]),u(x[w+1][P+1]),u(x[w+1][P]))}}function c(y){let T=new R;for(let v=0;v<r.length;v+=3)T.x=r[v+0],T.y=r[v+1],T.z=r[v+2],T.normalize().multiplyScalar(y),r[v+0]=T.x,r[v+1]=T.y,r[v+2]=T.z}function d(){let y=new R;for(let T=0;T<r.length;T+=3){y.x=r[T+0],y.y=r[T+1],y.z=r[T+2];let v=m(y)/2/Math.PI+.5,M=g(y)/Math.PI+.5;o.push(v,1-M)}p(),h()}function h(){for(let y=0;y<o.length;y+=6){let T=o[y+0],v=o[y+2],M=o[y+4],b=Math.max(T,v,M),x=Math.min(T,v,M);b>.9&&x<.1&&(T<.2&&(o[y+0]+=1),v<.2&&(o[y+2]+=1),M<.2&&(o[y+4]+=1))}}function u(y){r.push(y.x,y.y,y.z)}function f(y,T){let v=y*3;T.x=t[v+0],T.y=t[v+1],T.z=t[v+2]}function p(){let y=new R,T=new R,v=new R,M=new R,b=new Bt,x=new Bt,w=new Bt;for(let O=0,P=0;O<r.length;O+=9,P+=6){y.set(r[O+0],r[O+1],r[O+2]),T.set(r[O+3],r[O+4],r[O+5]),v.set(r[O+6],r[O+7],r[O+8]),b.set(o[P+0],o[P+1]),x.set(o[P+2],o[P+3]),w.set(o[P+4],o[P+5]),M.copy(y).add(T).add(v).divideScalar(3);let L=m(M);_(b,P+0,y,L),_(x,P+2,T,L),_(w,P+4,v,L)}}function _(y,T,v,M){M<0&&y.x===1&&(o[T]=y.x-1),v.x===0&&v.z===0&&(o[T]=M/2/Math.PI+.5)}function m(y){return Math.atan2(y.z,-y.x)}function g(y){return Math.atan2(-y.y,Math.sqrt(y.x*y.x+y.z*y.z))}}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.vertices,t.indices,t.radius,t.detail)}};var rr=class i extends Lc{constructor(t=1,e=0){let n=[1,0,0,-1,0,0,0,1,0,0,-1,0,0,0,1,0,0,-1],s=[0,2,4,0,4,3,0,3,5,0,5,2,1,2,5,1,5,3,1,3,4,1,4,2];super(n,s,t,e),this.type="OctahedronGeometry",this.parameters={radius:t,detail:e}}static fromJSON(t){return new i(t.radius,t.detail)}},gi=class i extends pe{constructor(t=1,e=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:t,height:e,widthSegments:n,heightSegments:s};let r=t/2,o=e/2,a=Math.floor(n),l=Math.floor(s),c=a+1,d=l+1,h=t/a,u=e/l,f=[],p=[],_=[],m=[];for(let g=0;g<d;g++){let y=g*u-o;for(let T=0;T<c;T++){let v=T*h-r;p.push(v,-y,0),_.push(0,0,1),m.push(T/a),m.push(1-g/l)}}for(let g=0;g<l;g++)for(let y=0;y<a;y++){let T=y+c*g,v=y+c*(g+1),M=y+1+c*(g+1),b=y+1+c*g;f.push(T,v,b),f.push(v,M,b)}this.setIndex(f),this.setAttribute("position",new ie(p,3)),this.setAttribute("normal",new ie(_,3)),this.setAttribute("uv",new ie(m,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.width,t.height,t.widthSegments,t.heightSegments)}};var hi=class i extends pe{constructor(t=1,e=32,n=16,s=0,r=Math.PI*2,o=0,a=Math.PI){super(),this.type="SphereGeometry",this.parameters={radius:t,widthSegments:e,heightSegments:n,phiStart:s,phiLength:r,thetaStart:o,thetaLength:a},e=Math.max(3,Math.floor(e)),n=Math.max(2,Math.floor(n));let l=Math.min(o+a,Math.PI),c=0,d=[],h=new R,u=new R,f=[],p=[],_=[],m=[];for(let g=0;g<=n;g++){let y=[],T=g/n,v=o+T*a,M=t*Math.cos(v),b=Math.sqrt(t*t-M*M),x=0;g===0&&o===0?x=.5/e:g===n&&l===Math.PI&&(x=-.5/e);for(let w=0;w<=e;w++){let O=w/e,P=s+O*r;h.x=-b*Math.cos(P),h.y=M,h.z=b*Math.sin(P),p.push(h.x,h.y,h.z),u.copy(h).normalize(),_.push(u.x,u.y,u.z),m.push(O+x,1-T),y.push(c++)}d.push(y)}for(let g=0;g<n;g++)for(let y=0;y<e;y++){let T=d[g][y+1],v=d[g][y],M=d[g+1][y],b=d[g+1][y+1];(g!==0||o>0)&&f.push(T,v,b),(g!==n-1||l<Math.PI)&&f.push(v,M,b)}this.setIndex(f),this.setAttribute("position",new ie(p,3)),this.setAttribute("normal",new ie(_,3)),this.setAttribute("uv",new ie(m,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.radius,t.widthSegments,t.heightSegments,t.phiStart,t.phiLength,t.thetaStart,t.thetaLength)}};var Bs=class i extends pe{constructor(t=1,e=.4,n=12,s=48,r=Math.PI*2,o=0,a=Math.PI*2){super(),this.type="TorusGeometry",this.parameters={radius:t,tube:e,radialSegments:n,tubularSegments:s,arc:r,thetaStart:o,thetaLength:a},n=Math.floor(n),s=Math.floor(s);let l=[],c=[],d=[],h=[],u=new R,f=new R,p=new R;for(let _=0;_<=n;_++){let m=o+_/n*a;for(let g=0;g<=s;g++){let y=g/s*r;f.x=(t+e*Math.cos(m))*Math.cos(y),f.y=(t+e*Math.cos(m))*Math.sin(y),f.z=e*Math.sin(m),c.push(f.x,f.y,f.z),u.x=t*Math.cos(y),u.y=t*Math.sin(y),p.subVectors(f,u).normalize(),d.push(p.x,p.y,p.z),h.push(g/s),h.push(_/n)}}for(let _=1;_<=n;_++)for(let m=1;m<=s;m++){let g=(s+1)*_+m-1,y=(s+1)*(_-1)+m-1,T=(s+1)*(_-1)+m,v=(s+1)*_+m;l.push(g,y,v),l.push(y,T,v)}this.setIndex(l),this.setAttribute("position",new ie(c,3)),this.setAttribute("normal",new ie(d,3)),this.setAttribute("uv",new ie(h,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.radius,t.tube,t.radialSegments,t.tubularSegments,t.arc,t.thetaStart,t.thetaLength)}};var $a=class extends pe{constructor(t=null){if(super(),this.type="WireframeGeometry",this.parameters={geometry:t},t!==null){let e=[],n=new Set,s=new R,r=new R;if(t.index!==null){let o=t.attributes.position,a=t.index,l=t.groups;l.length===0&&(l=[{start:0,count:a.count,materialIndex:0}]);for(let c=0,d=l.length;c<d;++c){let h=l[c],u=h.start,f=h.count;for(let p=u,_=u+f;p<_;p+=3)for(let m=0;m<3;m++){let g=a.getX(p+m),y=a.getX(p+(m+1)%3);s.fromBufferAttribute(o,g),r.fromBufferAttribute(o,y),Mm(s,r,n)===!0&&(e.push(s.x,s.y,s.z),e.push(r.x,r.y,r.z))}}}else{let o=t.attributes.position;for(let a=0,l=o.count/3;a<l;a++)for(let c=0;c<3;c++){let d=3*a+c,h=3*a+(c+1)%3;s.fromBufferAttribute(o,d),r.fromBufferAttribute(o,h),Mm(s,r,n)===!0&&(e.push(s.x,s.y,s.z),e.push(r.x,r.y,r.z))}}this.setAttribute("position",new ie(e,3))}}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}};function Mm(i,t,e){let n=`${i.x},${i.y},${i.z}-${t.x},${t.y},${t.z}`,s=`${t.x},${t.y},${t.z}-${i.x},${i.y},${i.z}`;return e.has(n)===!0||e.has(s)===!0?!1:(e.add(n),e.add(s),!0)}function Ur(i){let t={};for(let e in i){t[e]={};for(let n in i[e]){let s=i[e][n];if(wm(s))s.isRenderTargetTexture?(jt("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),t[e][n]=null):t[e][n]=s.clone();else if(Array.isArray(s))if(wm(s[0])){let r=[];for(let o=0,a=s.length;o<a;o++)r[o]=s[o].clone();t[e][n]=r}else t[e][n]=s.slice();else t[e][n]=s}}return t}function ei(i){let t={};for(let e=0;e<i.length;e++){let n=Ur(i[e]);for(let s in n)t[s]=n[s]}return t}function wm(i){return i&&(i.isColor||i.isMatrix3||i.isMatrix4||i.isVector2||i.isVector3||i.isVector4||i.isTexture||i.isQuaternion)}function ky(i){let t=[];for(let e=0;e<i.length;e++)t.push(i[e].clone());return t}function rf(i){let t=i.getRenderTarget();return t===null?i.outputColorSpace:t.isXRRenderTarget===!0?t.texture.colorSpace:Se.workingColorSpace}var ml={clone:Ur,merge:ei},zy=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Vy=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,ui=class extends Ui{constructor(t){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=zy,this.fragmentShader=Vy,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,t!==void 0&&this.setValues(t)}copy(t){return super.copy(t),this.fragmentShader=t.fragmentShader,this.vertexShader=t.vertexShader,this.uniforms=Ur(t.uniforms),this.uniformsGroups=ky(t.uniformsGroups),this.defines=Object.assign({},t.defines),this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.fog=t.fog,this.lights=t.lights,this.clipping=t.clipping,this.extensions=Object.assign({},t.extensions),this.glslVersion=t.glslVersion,this.defaultAttributeValues=Object.assign({},t.defaultAttributeValues),this.index0AttributeName=t.index0AttributeName,this.uniformsNeedUpdate=t.uniformsNeedUpdate,this}toJSON(t){let e=super.toJSON(t);e.glslVersion=this.glslVersion,e.uniforms={};for(let s in this.uniforms){let o=this.uniforms[s].value;o&&o.isTexture?e.uniforms[s]={type:"t",value:o.toJSON(t).uuid}:o&&o.isColor?e.uniforms[s]={type:"c",value:o.getHex()}:o&&o.isVector2?e.uniforms[s]={type:"v2",value:o.toArray()}:o&&o.isVector3?e.uniforms[s]={type:"v3",value:o.toArray()}:o&&o.isVector4?e.uniforms[s]={type:"v4",value:o.toArray()}:o&&o.isMatrix3?e.uniforms[s]={type:"m3",value:o.toArray()}:o&&o.isMatrix4?e.uniforms[s]={type:"m4",value:o.toArray()}:e.uniforms[s]={value:o}}Object.keys(this.defines).length>0&&(e.defines=this.defines),e.vertexShader=this.vertexShader,e.fragmentShader=this.fragmentShader,e.lights=this.lights,e.clipping=this.clipping;let n={};for(let s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(e.extensions=n),e}fromJSON(t,e){if(super.fromJSON(t,e),t.uniforms!==void 0)for(let n in t.uniforms){let s=t.uniforms[n];switch(this.uniforms[n]={},s.type){case"t":this.uniforms[n].value=e[s.value]||null;break;case"c":this.uniforms[n].value=new Xt().setHex(s.value);break;case"v2":this.uniforms[n].value=new Bt().fromArray(s.value);break;case"v3":this.uniforms[n].value=new R().fromArray(s.value);break;case"v4":this.uniforms[n].value=new De().fromArray(s.value);break;case"m3":this.uniforms[n].value=new re().fromArray(s.value);break;case"m4":this.uniforms[n].value=new Wt().fromArray(s.value);break;default:this.uniforms[n].value=s.value}}if(t.defines!==void 0&&(this.defines=t.defines),t.vertexShader!==void 0&&(this.vertexShader=t.vertexShader),t.fragmentShader!==void 0&&(this.fragmentShader=t.fragmentShader),t.glslVersion!==void 0&&(this.glslVersion=t.glslVersion),t.extensions!==void 0)for(let n in t.extensions)this.extensions[n]=t.extensions[n];return t.lights!==void 0&&(this.lights=t.lights),t.clipping!==void 0&&(this.clipping=t.clipping),this}},Dc=class extends ui{constructor(t){super(t),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}},Za=class extends Ui{constructor(t){super(),this.isMeshStandardMaterial=!0,this.type="MeshStandardMaterial",this.defines={STANDARD:""},this.color=new Xt(16777215),this.roughness=1,this.metalness=0,this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new Xt(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=fl,this.normalScale=new Bt(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.roughnessMap=null,this.metalnessMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Qn,this.envMapIntensity=1,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.flatShading=!1,this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.defines={STANDARD:""},this.color.copy(t.color),this.roughness=t.roughness,this.metalness=t.metalness,this.map=t.map,this.lightMap=t.lightMap,this.lightMapIntensity=t.lightMapIntensity,this.aoMap=t.aoMap,this.aoMapIntensity=t.aoMapIntensity,this.emissive.copy(t.emissive),this.emissiveMap=t.emissiveMap,this.emissiveIntensity=t.emissiveIntensity,this.bumpMap=t.bumpMap,this.bumpScale=t.bumpScale,this.normalMap=t.normalMap,this.normalMapType=t.normalMapType,this.normalScale.copy(t.normalScale),this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this.roughnessMap=t.roughnessMap,this.metalnessMap=t.metalnessMap,this.alphaMap=t.alphaMap,this.envMap=t.envMap,this.envMapRotation.copy(t.envMapRotation),this.envMapIntensity=t.envMapIntensity,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.wireframeLinecap=t.wireframeLinecap,this.wireframeLinejoin=t.wireframeLinejoin,this.flatShading=t.flatShading,this.fog=t.fog,this}};var us=class extends Ui{constructor(t){super(),this.isMeshLambertMaterial=!0,this.type="MeshLambertMaterial",this.color=new Xt(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new Xt(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=fl,this.normalScale=new Bt(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Qn,this.combine=qc,this.reflectivity=1,this.envMapIntensity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.flatShading=!1,this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.lightMap=t.lightMap,this.lightMapIntensity=t.lightMapIntensity,this.aoMap=t.aoMap,this.aoMapIntensity=t.aoMapIntensity,this.emissive.copy(t.emissive),this.emissiveMap=t.emissiveMap,this.emissiveIntensity=t.emissiveIntensity,this.bumpMap=t.bumpMap,this.bumpScale=t.bumpScale,this.normalMap=t.normalMap,this.normalMapType=t.normalMapType,this.normalScale.copy(t.normalScale),this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this.specularMap=t.specularMap,this.alphaMap=t.alphaMap,this.envMap=t.envMap,this.envMapRotation.copy(t.envMapRotation),this.combine=t.combine,this.reflectivity=t.reflectivity,this.envMapIntensity=t.envMapIntensity,this.refractionRatio=t.refractionRatio,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.wireframeLinecap=t.wireframeLinecap,this.wireframeLinejoin=t.wireframeLinejoin,this.flatShading=t.flatShading,this.fog=t.fog,this}},Nc=class extends Ui{constructor(t){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=sg,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(t)}copy(t){return super.copy(t),this.depthPacking=t.depthPacking,this.map=t.map,this.alphaMap=t.alphaMap,this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this}},Oc=class extends Ui{constructor(t){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(t)}copy(t){return super.copy(t),this.map=t.map,this.alphaMap=t.alphaMap,this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this}};function So(i,t){return!i||i.constructor===t?i:typeof t.BYTES_PER_ELEMENT=="number"?new t(i):Array.prototype.slice.call(i)}function hc(i){return i!==void 0&&i.inTangents!==void 0&&i.outTangents!==void 0}var or=class{constructor(t,e,n,s){this.parameterPositions=t,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new e.constructor(n),this.sampleValues=e,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(t){let e=this.parameterPositions,n=this._cachedIndex,s=e[n],r=e[n-1];n:{t:{let o;e:{i:if(!(t<s)){for(let a=n+2;;){if(s===void 0){if(t<r)break i;return n=e.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===a)break;if(r=s,s=e[++n],t<s)break t}o=e.length;break e}if(!(t>=r)){let a=e[1];t<a&&(n=2,r=a);for(let l=n-2;;){if(r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===l)break;if(s=r,r=e[--n-1],t>=r)break t}o=n,n=0;break e}break n}for(;n<o;){let a=n+o>>>1;t<e[a]?o=a:n=a+1}if(s=e[n],r=e[n-1],r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return n=e.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,r,s)}return this.interpolate_(n,r,t,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(t){let e=this.resultBuffer,n=this.sampleValues,s=this.valueSize,r=t*s;for(let o=0;o!==s;++o)e[o]=n[r+o];return e}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},Uc=class extends or{constructor(t,e,n,s){super(t,e,n,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:yd,endingEnd:yd}}intervalChanged_(t,e,n){let s=this.parameterPositions,r=t-2,o=t+1,a=s[r],l=s[o];if(a===void 0)switch(this.getSettings_().endingStart){case vd:r=t,a=2*e-n;break;case Sd:r=s.length-2,a=e+s[r]-s[r+1];break;default:r=t,a=n}if(l===void 0)switch(this.getSettings_().endingEnd){case vd:o=t,l=2*n-e;break;case Sd:o=1,l=n+s[1]-s[0];break;default:o=t-1,l=e}let c=(n-e)*.5,d=this.valueSize;this._weightPrev=c/(e-a),this._weightNext=c/(l-n),this._offsetPrev=r*d,this._offsetNext=o*d}interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=t*a,c=l-a,d=this._offsetPrev,h=this._offsetNext,u=this._weightPrev,f=this._weightNext,p=(n-e)/(s-e),_=p*p,m=_*p,g=-u*m+2*u*_-u*p,y=(1+u)*m+(-1.5-2*u)*_+(-.5+u)*p+1,T=(-1-f)*m+(1.5+f)*_+.5*p,v=f*m-f*_;for(let M=0;M!==a;++M)r[M]=g*o[d+M]+y*o[c+M]+T*o[l+M]+v*o[h+M];return r}},Fc=class extends or{constructor(t,e,n,s){super(t,e,n,s)}interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=t*a,c=l-a,d=(n-e)/(s-e),h=1-d;for(let u=0;u!==a;++u)r[u]=o[c+u]*h+o[l+u]*d;return r}},Bc=class extends or{constructor(t,e,n,s){super(t,e,n,s)}interpolate_(t){return this.copySampleValue_(t-1)}},kc=class extends or{interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=t*a,c=l-a,d=this.inTangents,h=this.outTangents;if(!d||!h){let p=(n-e)/(s-e),_=1-p;for(let m=0;m!==a;++m)r[m]=o[c+m]*_+o[l+m]*p;return r}let u=a*2,f=t-1;for(let p=0;p!==a;++p){let _=o[c+p],m=o[l+p],g=f*u+p*2,y=h[g],T=h[g+1],v=t*u+p*2,M=d[v],b=d[v+1],x=Hy(n,e,y,M,s);r[p]=xg(x,_,T,b,m)}return r}};function xg(i,t,e,n,s){let r=1-i;return r*r*r*t+3*r*r*i*e+3*r*i*i*n+i*i*i*s}function Gy(i,t,e,n,s){let r=1-i;return 3*r*r*(e-t)+6*r*i*(n-e)+3*i*i*(s-n)}function Hy(i,t,e,n,s){let r=(i-t)/(s-t);for(let o=0;o<8;o++){let a=xg(r,t,e,n,s)-i;if(Math.abs(a)<1e-10)break;let l=Gy(r,t,e,n,s);if(Math.abs(l)<1e-10)break;r=Math.max(0,Math.min(1,r-a/l))}return r}var Ci=class{constructor(t,e,n,s){if(t===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(e===void 0||e.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+t);this.name=t,this.times=So(e,this.TimeBufferType),this.values=So(n,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(t){let e=t.constructor,n;if(e.toJSON!==this.toJSON)n=e.toJSON(t);else{n={name:t.name,times:So(t.times,Array),values:So(t.values,Array)};let s=t.getInterpolation();s!==t.DefaultInterpolation&&(n.interpolation=s),hc(t.settings)&&(n.settings={inTangents:So(t.settings.inTangents,Array),outTangents:So(t.settings.outTangents,Array)})}return n.type=t.ValueTypeName,n}InterpolantFactoryMethodDiscrete(t){return new Bc(this.times,this.values,this.getValueSize(),t)}InterpolantFactoryMethodLinear(t){return new Fc(this.times,this.values,this.getValueSize(),t)}InterpolantFactoryMethodSmooth(t){return new Uc(this.times,this.values,this.getValueSize(),t)}InterpolantFactoryMethodBezier(t){let e=new kc(this.times,this.values,this.getValueSize(),t);return this.settings&&(e.inTangents=this.settings.inTangents,e.outTangents=this.settings.outTangents),e}setInterpolation(t){let e;switch(t){case Pa:e=this.InterpolantFactoryMethodDiscrete;break;case Tc:e=this.InterpolantFactoryMethodLinear;break;case mc:e=this.InterpolantFactoryMethodSmooth;break;case xd:e=this.InterpolantFactoryMethodBezier;break}if(e===void 0){let n="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(t!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(n);return jt("KeyframeTrack:",n),this}return this.createInterpolant=e,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return Pa;case this.InterpolantFactoryMethodLinear:return Tc;case this.InterpolantFactoryMethodSmooth:return mc;case this.InterpolantFactoryMethodBezier:return xd}}getValueSize(){return this.values.length/this.times.length}shift(t){if(t!==0){let e=this.times;for(let n=0,s=e.length;n!==s;++n)e[n]+=t;hc(this.settings)&&(bm(this.settings.inTangents,t),bm(this.settings.outTangents,t))}return this}scale(t){if(t!==1){let e=this.times;for(let n=0,s=e.length;n!==s;++n)e[n]*=t;hc(this.settings)&&(Tm(this.settings.inTangents,t),Tm(this.settings.outTangents,t))}return this}trim(t,e){let n=this.times,s=n.length,r=0,o=s-1;for(;r!==s&&n[r]<t;)++r;for(;o!==-1&&n[o]>e;)--o;if(++o,r!==0||o!==s){r>=o&&(o=Math.max(o,1),r=o-1);let a=this.getValueSize();this.times=n.slice(r,o),this.values=this.values.slice(r*a,o*a)}return this}validate(){let t=!0,e=this.getValueSize();e-Math.floor(e)!==0&&(te("KeyframeTrack: Invalid value size in track.",this),t=!1);let n=this.times,s=this.values,r=n.length;r===0&&(te("KeyframeTrack: Track is empty.",this),t=!1);let o=null;for(let a=0;a!==r;a++){let l=n[a];if(typeof l=="number"&&isNaN(l)){te("KeyframeTrack: Time is not a valid number.",this,a,l),t=!1;break}if(o!==null&&o>l){te("KeyframeTrack: Out of order keys.",this,a,l,o),t=!1;break}o=l}if(s!==void 0&&sy(s))for(let a=0,l=s.length;a!==l;++a){let c=s[a];if(isNaN(c)){te("KeyframeTrack: Value is not a valid number.",this,a,c),t=!1;break}}return t}optimize(){let t=this.times.slice(),e=this.values.slice(),n=this.getValueSize(),s=this.getInterpolation()===mc,r=t.length-1,o=1;for(let a=1;a<r;++a){let l=!1,c=t[a],d=t[a+1];if(c!==d&&(a!==1||c!==t[0]))if(s)l=!0;else{let h=a*n,u=h-n,f=h+n;for(let p=0;p!==n;++p){let _=e[h+p];if(_!==e[u+p]||_!==e[f+p]){l=!0;break}}}if(l){if(a!==o){t[o]=t[a];let h=a*n,u=o*n;for(let f=0;f!==n;++f)e[u+f]=e[h+f]}++o}}if(r>0){t[o]=t[r];for(let a=r*n,l=o*n,c=0;c!==n;++c)e[l+c]=e[a+c];++o}return o!==t.length?(this.times=t.slice(0,o),this.values=e.slice(0,o*n)):(this.times=t,this.values=e),this}clone(){let t=this.times.slice(),e=this.values.slice(),n=this.constructor,s=new n(this.name,t,e);return s.createInterpolant=this.createInterpolant,hc(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function bm(i,t){for(let e=0,n=i.length;e!==n;e+=2)i[e]+=t}function Tm(i,t){for(let e=0,n=i.length;e!==n;e+=2)i[e]*=t}Ci.prototype.ValueTypeName="";Ci.prototype.TimeBufferType=Float32Array;Ci.prototype.ValueBufferType=Float32Array;Ci.prototype.DefaultInterpolation=Tc;var ar=class extends Ci{constructor(t,e,n){super(t,e,n)}};ar.prototype.ValueTypeName="bool";ar.prototype.ValueBufferType=Array;ar.prototype.DefaultInterpolation=Pa;ar.prototype.InterpolantFactoryMethodLinear=void 0;ar.prototype.InterpolantFactoryMethodSmooth=void 0;var zc=class extends Ci{constructor(t,e,n,s){super(t,e,n,s)}};zc.prototype.ValueTypeName="color";var Vc=class extends Ci{constructor(t,e,n,s){super(t,e,n,s)}};Vc.prototype.ValueTypeName="number";var Gc=class extends or{constructor(t,e,n,s){super(t,e,n,s)}interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=(n-e)/(s-e),c=t*a;for(let d=c+a;c!==d;c+=4)ze.slerpFlat(r,0,o,c-a,o,c,l);return r}},Ja=class extends Ci{constructor(t,e,n,s){super(t,e,n,s)}InterpolantFactoryMethodLinear(t){return new Gc(this.times,this.values,this.getValueSize(),t)}};Ja.prototype.ValueTypeName="quaternion";Ja.prototype.InterpolantFactoryMethodSmooth=void 0;var lr=class extends Ci{constructor(t,e,n){super(t,e,n)}};lr.prototype.ValueTypeName="string";lr.prototype.ValueBufferType=Array;lr.prototype.DefaultInterpolation=Pa;lr.prototype.InterpolantFactoryMethodLinear=void 0;lr.prototype.InterpolantFactoryMethodSmooth=void 0;var Hc=class extends Ci{constructor(t,e,n,s){super(t,e,n,s)}};Hc.prototype.ValueTypeName="vector";var Wc=class{constructor(t,e,n){let s=this,r=!1,o=0,a=0,l,c=[];this.onStart=void 0,this.onLoad=t,this.onProgress=e,this.onError=n,this._abortController=null,this.itemStart=function(d){a++,r===!1&&s.onStart!==void 0&&s.onStart(d,o,a),r=!0},this.itemEnd=function(d){o++,s.onProgress!==void 0&&s.onProgress(d,o,a),o===a&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(d){s.onError!==void 0&&s.onError(d)},this.resolveURL=function(d){return d=d.normalize("NFC"),l?l(d):d},this.setURLModifier=function(d){return l=d,this},this.addHandler=function(d,h){return c.push(d,h),this},this.removeHandler=function(d){let h=c.indexOf(d);return h!==-1&&c.splice(h,2),this},this.getHandler=function(d){for(let h=0,u=c.length;h<u;h+=2){let f=c[h],p=c[h+1];if(f.global&&(f.lastIndex=0),f.test(d))return p}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||(this._abortController=new AbortController),this._abortController}},yg=new Wc,Xc=class{constructor(t){this.manager=t!==void 0?t:yg,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default",typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}load(){}loadAsync(t,e){let n=this;return new Promise(function(s,r){n.load(t,s,e,r)})}parse(){}setCrossOrigin(t){return this.crossOrigin=t,this}setWithCredentials(t){return this.withCredentials=t,this}setPath(t){return this.path=t,this}setResourcePath(t){return this.resourcePath=t,this}setRequestHeader(t){return this.requestHeader=t,this}setPriority(t){return this.priority=t,this}setCache(t){return this.cache=t,this}abort(){return this}};Xc.DEFAULT_MATERIAL_NAME="__DEFAULT";var Rr=class extends Ee{static registerNode(t){this.prototype._lightNode=t}constructor(t,e=1){super(),this.isLight=!0,this.type="Light",this.color=new Xt(t),this.intensity=e}copy(t,e){return super.copy(t,e),this.color.copy(t.color),this.intensity=t.intensity,this}toJSON(t){let e=super.toJSON(t);return e.object.color=this.color.getHex(),e.object.intensity=this.intensity,e}},ja=class extends Rr{constructor(t,e,n){super(t,n),this.isHemisphereLight=!0,this.type="HemisphereLight",this.position.copy(Ee.DEFAULT_UP),this.updateMatrix(),this.groundColor=new Xt(e)}copy(t,e){return super.copy(t,e),this.groundColor.copy(t.groundColor),this}toJSON(t){let e=super.toJSON(t);return e.object.groundColor=this.groundColor.getHex(),e}},md=new Wt,Em=new R,Am=new R,Fo=class{constructor(t){this.camera=t,this.intensity=1,this.bias=0,this.biasNode=null,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new Bt(512,512),this.mapType=_i,this.map=null,this.mapPass=null,this.matrix=new Wt,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new nr,this._frameExtents=new Bt(1,1),this._viewportCount=1,this._viewports=[new De(0,0,1,1)]}getViewportCount(){return this._viewportCount}getCamera(){return this.camera}getFrustum(){return this._frustum}updateMatrices(t){let e=this.camera;Em.setFromMatrixPosition(t.matrixWorld),e.position.copy(Em),Am.setFromMatrixPosition(t.target.matrixWorld),e.lookAt(Am),e.updateMatrixWorld(),this._updateMatrix(e,this.matrix,this._frustum)}_updateMatrix(t,e,n,s){md.multiplyMatrices(t.projectionMatrix,t.matrixWorldInverse),n.setFromProjectionMatrix(md,t.coordinateSystem,t.reversedDepth);let r=this._frameExtents,o=s?s.z/r.x:1,a=s?s.w/r.y:1,l=s?s.x/r.x:0,c=s?s.y/r.y:0;t.coordinateSystem===Ro||t.reversedDepth?e.set(.5*o,0,0,.5*o+l,0,.5*a,0,.5*a+c,0,0,1,0,0,0,0,1):e.set(.5*o,0,0,.5*o+l,0,.5*a,0,.5*a+c,0,0,.5,.5,0,0,0,1),e.multiply(md)}getViewport(t){return this._viewports[t]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(t){return this.camera=t.camera.clone(),this.intensity=t.intensity,this.bias=t.bias,this.radius=t.radius,this.autoUpdate=t.autoUpdate,this.needsUpdate=t.needsUpdate,this.normalBias=t.normalBias,this.blurSamples=t.blurSamples,this.mapSize.copy(t.mapSize),this.mapType=t.mapType,this.biasNode=t.biasNode,this}clone(){return new this.constructor().copy(this)}toJSON(){let t={};return t.intensity=this.intensity,t.bias=this.bias,t.normalBias=this.normalBias,t.radius=this.radius,t.blurSamples=this.blurSamples,t.mapSize=this.mapSize.toArray(),t.mapType=this.mapType,t.camera=this.camera.toJSON(!1).object,delete t.camera.matrix,t}},uc=new R,dc=new ze,cs=new R,Ka=class extends Ee{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new Wt,this.projectionMatrix=new Wt,this.projectionMatrixInverse=new Wt,this.coordinateSystem=Oi,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(t,e){return super.copy(t,e),this.matrixWorldInverse.copy(t.matrixWorldInverse),this.projectionMatrix.copy(t.projectionMatrix),this.projectionMatrixInverse.copy(t.projectionMatrixInverse),this.coordinateSystem=t.coordinateSystem,this}getWorldDirection(t){return super.getWorldDirection(t).negate()}updateMatrixWorld(t){super.updateMatrixWorld(t),this.matrixWorld.decompose(uc,dc,cs),cs.x===1&&cs.y===1&&cs.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(uc,dc,cs.set(1,1,1)).invert()}updateWorldMatrix(t,e,n=!1){super.updateWorldMatrix(t,e,n),this.matrixWorld.decompose(uc,dc,cs),cs.x===1&&cs.y===1&&cs.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(uc,dc,cs.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},er=new R,Cm=new Bt,Rm=new Bt,An=class extends Ka{constructor(t=50,e=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=t,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=e,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(t,e){return super.copy(t,e),this.fov=t.fov,this.zoom=t.zoom,this.near=t.near,this.far=t.far,this.focus=t.focus,this.aspect=t.aspect,this.view=t.view===null?null:Object.assign({},t.view),this.filmGauge=t.filmGauge,this.filmOffset=t.filmOffset,this}setFocalLength(t){let e=.5*this.getFilmHeight()/t;this.fov=Er*2*Math.atan(e),this.updateProjectionMatrix()}getFocalLength(){let t=Math.tan(Ca*.5*this.fov);return .5*this.getFilmHeight()/t}getEffectiveFOV(){return Er*2*Math.atan(Math.tan(Ca*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(t,e,n){er.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),e.set(er.x,er.y).multiplyScalar(-t/er.z),er.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(er.x,er.y).multiplyScalar(-t/er.z)}getViewSize(t,e){return this.getViewBounds(t,Cm,Rm),e.subVectors(Rm,Cm)}setViewOffset(t,e,n,s,r,o){this.aspect=t/e,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=t,this.view.fullHeight=e,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let t=this.near,e=t*Math.tan(Ca*.5*this.fov)/this.zoom,n=2*e,s=this.aspect*n,r=-.5*s,o=this.view;if(this.view!==null&&this.view.enabled){let l=o.fullWidth,c=o.fullHeight;r+=o.offsetX*s/l,e-=o.offsetY*n/c,s*=o.width/l,n*=o.height/c}let a=this.filmOffset;a!==0&&(r+=t*a/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,e,e-n,t,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(t){let e=super.toJSON(t);return e.object.fov=this.fov,e.object.zoom=this.zoom,e.object.near=this.near,e.object.far=this.far,e.object.focus=this.focus,e.object.aspect=this.aspect,this.view!==null&&(e.object.view=Object.assign({},this.view)),e.object.filmGauge=this.filmGauge,e.object.filmOffset=this.filmOffset,e}},wd=class extends Fo{constructor(){super(new An(50,1,.5,500)),this.isSpotLightShadow=!0,this.focus=1,this.aspect=1}updateMatrices(t){let e=this.camera,n=Er*2*t.angle*this.focus,s=this.mapSize.width/this.mapSize.height*this.aspect,r=t.distance||e.far;(n!==e.fov||s!==e.aspect||r!==e.far)&&(e.fov=n,e.aspect=s,e.far=r,e.updateProjectionMatrix()),super.updateMatrices(t)}copy(t){return super.copy(t),this.focus=t.focus,this.aspect=t.aspect,this}toJSON(){let t=super.toJSON();return t.focus=this.focus,t.aspect=this.aspect,t}},Qa=class extends Rr{constructor(t,e,n=0,s=Math.PI/3,r=0,o=2){super(t,e),this.isSpotLight=!0,this.type="SpotLight",this.position.copy(Ee.DEFAULT_UP),this.updateMatrix(),this.target=new Ee,this.distance=n,this.angle=s,this.penumbra=r,this.decay=o,this.map=null,this.shadow=new wd}get power(){return this.intensity*Math.PI}set power(t){this.intensity=t/Math.PI}dispose(){super.dispose(),this.shadow.dispose()}copy(t,e){return super.copy(t,e),this.distance=t.distance,this.angle=t.angle,this.penumbra=t.penumbra,this.decay=t.decay,this.target=t.target.clone(),this.map=t.map,this.shadow=t.shadow.clone(),this}toJSON(t){let e=super.toJSON(t);return e.object.distance=this.distance,e.object.angle=this.angle,e.object.decay=this.decay,e.object.penumbra=this.penumbra,e.object.target=this.target.uuid,this.map&&this.map.isTexture&&(e.object.map=this.map.toJSON(t).uuid),e.object.shadow=this.shadow.toJSON(),e}},bd=class extends Fo{constructor(){super(new An(90,1,.5,500)),this.isPointLightShadow=!0}},tl=class extends Rr{constructor(t,e,n=0,s=2){super(t,e),this.isPointLight=!0,this.type="PointLight",this.distance=n,this.decay=s,this.shadow=new bd}get power(){return this.intensity*4*Math.PI}set power(t){this.intensity=t/(4*Math.PI)}dispose(){super.dispose(),this.shadow.dispose()}copy(t,e){return super.copy(t,e),this.distance=t.distance,this.decay=t.decay,this.shadow=t.shadow.clone(),this}toJSON(t){let e=super.toJSON(t);return e.object.distance=this.distance,e.object.decay=this.decay,e.object.shadow=this.shadow.toJSON(),e}},el=class extends Ka{constructor(t=-1,e=1,n=1,s=-1,r=.1,o=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=t,this.right=e,this.top=n,this.bottom=s,this.near=r,this.far=o,this.updateProjectionMatrix()}copy(t,e){return super.copy(t,e),this.left=t.left,this.right=t.right,this.top=t.top,this.bottom=t.bottom,this.near=t.near,this.far=t.far,this.zoom=t.zoom,this.view=t.view===null?null:Object.assign({},t.view),this}setViewOffset(t,e,n,s,r,o){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=t,this.view.fullHeight=e,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let t=(this.right-this.left)/(2*this.zoom),e=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=n-t,o=n+t,a=s+e,l=s-e;if(this.view!==null&&this.view.enabled){let c=(this.right-this.left)/this.view.fullWidth/this.zoom,d=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,o=r+c*this.view.width,a-=d*this.view.offsetY,l=a-d*this.view.height}this.projectionMatrix.makeOrthographic(r,o,a,l,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(t){let e=super.toJSON(t);return e.object.zoom=this.zoom,e.object.left=this.left,e.object.right=this.right,e.object.top=this.top,e.object.bottom=this.bottom,e.object.near=this.near,e.object.far=this.far,this.view!==null&&(e.object.view=Object.assign({},this.view)),e}},Td=class extends Fo{constructor(){super(new el(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}},Bo=class extends Rr{constructor(t,e){super(t,e),this.isDirectionalLight=!0,this.type="DirectionalLight",this.position.copy(Ee.DEFAULT_UP),this.updateMatrix(),this.target=new Ee,this.shadow=new Td}dispose(){super.dispose(),this.shadow.dispose()}copy(t){return super.copy(t),this.target=t.target.clone(),this.shadow=t.shadow.clone(),this}toJSON(t){let e=super.toJSON(t);return e.object.shadow=this.shadow.toJSON(),e.object.target=this.target.uuid,e}};var nl=class extends pe{constructor(){super(),this.isInstancedBufferGeometry=!0,this.type="InstancedBufferGeometry",this.instanceCount=1/0}copy(t){return super.copy(t),this.instanceCount=t.instanceCount,this}toJSON(){let t=super.toJSON();return t.instanceCount=this.instanceCount,t.isInstancedBufferGeometry=!0,t}};var Mo=-90,wo=1,ko=class extends Ee{constructor(t,e,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new An(Mo,wo,t,e);s.layers=this.layers,this.add(s);let r=new An(Mo,wo,t,e);r.layers=this.layers,this.add(r);let o=new An(Mo,wo,t,e);o.layers=this.layers,this.add(o);let a=new An(Mo,wo,t,e);a.layers=this.layers,this.add(a);let l=new An(Mo,wo,t,e);l.layers=this.layers,this.add(l);let c=new An(Mo,wo,t,e);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let t=this.coordinateSystem,e=this.children.concat(),[n,s,r,o,a,l]=e;for(let c of e)this.remove(c);if(t===Oi)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),o.up.set(0,0,1),o.lookAt(0,-1,0),a.up.set(0,1,0),a.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(t===Ro)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),o.up.set(0,0,-1),o.lookAt(0,-1,0),a.up.set(0,-1,0),a.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+t);for(let c of e)this.add(c),c.updateMatrixWorld()}update(t,e){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==t.coordinateSystem&&(this.coordinateSystem=t.coordinateSystem,this.updateCoordinateSystem());let[r,o,a,l,c,d]=this.children,h=t.getRenderTarget(),u=t.getActiveCubeFace(),f=t.getActiveMipmapLevel(),p=t.xr.enabled;t.xr.enabled=!1;let _=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let m=!1;t.isWebGLRenderer===!0?m=t.state.buffers.depth.getReversed():m=t.reversedDepthBuffer,t.setRenderTarget(n,0,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,r),t.setRenderTarget(n,1,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,o),t.setRenderTarget(n,2,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,a),t.setRenderTarget(n,3,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,l),t.setRenderTarget(n,4,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,c),n.texture.mipmapsAutoUpdate=_,t.setRenderTarget(n,5,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,d),t.setRenderTarget(h,u,f),t.xr.enabled=p,n.texture.needsPMREMUpdate=!0}},Yc=class extends An{constructor(t=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=t,this.perCameraFrustumCulled=!1}};var of="\\[\\]\\.:\\/",Wy=new RegExp("["+of+"]","g"),af="[^"+of+"]",Xy="[^"+of.replace("\\.","")+"]",Yy=/((?:WC+[\/:])*)/.source.replace("WC",af),qy=/(WCOD+)?/.source.replace("WCOD",Xy),$y=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",af),Zy=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",af),Jy=new RegExp("^"+Yy+qy+$y+Zy+"$"),jy=["material","materials","bones","map"],Ed=class{constructor(t,e,n){let s=n||je.parseTrackName(e);this._targetGroup=t,this._bindings=t.subscribe_(e,s)}getValue(t,e){this.bind();let n=this._targetGroup.nCachedObjects_,s=this._bindings[n];s!==void 0&&s.getValue(t,e)}setValue(t,e){let n=this._bindings;for(let s=this._targetGroup.nCachedObjects_,r=n.length;s!==r;++s)n[s].setValue(t,e)}bind(){let t=this._bindings;for(let e=this._targetGroup.nCachedObjects_,n=t.length;e!==n;++e)t[e].bind()}unbind(){let t=this._bindings;for(let e=this._targetGroup.nCachedObjects_,n=t.length;e!==n;++e)t[e].unbind()}},je=class i{constructor(t,e,n){this.path=e,this.parsedPath=n||i.parseTrackName(e),this.node=i.findNode(t,this.parsedPath.nodeName),this.rootNode=t,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(t,e,n){return t&&t.isAnimationObjectGroup?new i.Composite(t,e,n):new i(t,e,n)}static sanitizeNodeName(t){return t.replace(/\s/g,"_").replace(Wy,"")}static parseTrackName(t){let e=Jy.exec(t);if(e===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+t);let n={nodeName:e[2],objectName:e[3],objectIndex:e[4],propertyName:e[5],propertyIndex:e[6]},s=n.nodeName&&n.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=n.nodeName.substring(s+1);jy.indexOf(r)!==-1&&(n.nodeName=n.nodeName.substring(0,s),n.objectName=r)}if(n.propertyName===null||n.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+t);return n}static findNode(t,e){if(e===void 0||e===""||e==="."||e===-1||e===t.name||e===t.uuid)return t;if(t.skeleton){let n=t.skeleton.getBoneByName(e);if(n!==void 0)return n}if(t.children){let n=function(r){for(let o=0;o<r.length;o++){let a=r[o];if(a.name===e||a.uuid===e)return a;let l=n(a.children);if(l)return l}return null},s=n(t.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(t,e){t[e]=this.targetObject[this.propertyName]}_getValue_array(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)t[e++]=n[s]}_getValue_arrayElement(t,e){t[e]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(t,e){this.resolvedProperty.toArray(t,e)}_setValue_direct(t,e){this.targetObject[this.propertyName]=t[e]}_setValue_direct_setNeedsUpdate(t,e){this.targetObject[this.propertyName]=t[e],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(t,e){this.targetObject[this.propertyName]=t[e],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=t[e++]}_setValue_array_setNeedsUpdate(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=t[e++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=t[e++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(t,e){this.resolvedProperty[this.propertyIndex]=t[e]}_setValue_arrayElement_setNeedsUpdate(t,e){this.resolvedProperty[this.propertyIndex]=t[e],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(t,e){this.resolvedProperty[this.propertyIndex]=t[e],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(t,e){this.resolvedProperty.fromArray(t,e)}_setValue_fromArray_setNeedsUpdate(t,e){this.resolvedProperty.fromArray(t,e),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(t,e){this.resolvedProperty.fromArray(t,e),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(t,e){this.bind(),this.getValue(t,e)}_setValue_unbound(t,e){this.bind(),this.setValue(t,e)}bind(){let t=this.node,e=this.parsedPath,n=e.objectName,s=e.propertyName,r=e.propertyIndex;if(t||(t=i.findNode(this.rootNode,e.nodeName),this.node=t),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!t){jt("PropertyBinding: No target node found for track: "+this.path+".");return}if(n){let c=e.objectIndex;switch(n){case"materials":if(!t.material){te("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!t.material.materials){te("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}t=t.material.materials;break;case"bones":if(!t.skeleton){te("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}t=t.skeleton.bones;for(let d=0;d<t.length;d++)if(t[d].name===c){c=d;break}break;case"map":if("map"in t){t=t.map;break}if(!t.material){te("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!t.material.map){te("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}t=t.material.map;break;default:if(t[n]===void 0){te("PropertyBinding: Can not bind to objectName of node undefined.",this);return}t=t[n]}if(c!==void 0){if(t[c]===void 0){te("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,t);return}t=t[c]}}let o=t[s];if(o===void 0){let c=e.nodeName;te("PropertyBinding: Trying to update property for track: "+c+"."+s+" but it wasn't found.",t);return}let a=this.Versioning.None;this.targetObject=t,t.isMaterial===!0?a=this.Versioning.NeedsUpdate:t.isObject3D===!0&&(a=this.Versioning.MatrixWorldNeedsUpdate);let l=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!t.geometry){te("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!t.geometry.morphAttributes){te("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}t.morphTargetDictionary[r]!==void 0&&(r=t.morphTargetDictionary[r])}l=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=r}else o.fromArray!==void 0&&o.toArray!==void 0?(l=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(l=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=s;this.getValue=this.GetterByBindingType[l],this.setValue=this.SetterByBindingTypeAndVersioning[l][a]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};je.Composite=Ed;je.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};je.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};je.prototype.GetterByBindingType=[je.prototype._getValue_direct,je.prototype._getValue_array,je.prototype._getValue_arrayElement,je.prototype._getValue_toArray];je.prototype.SetterByBindingTypeAndVersioning=[[je.prototype._setValue_direct,je.prototype._setValue_direct_setNeedsUpdate,je.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[je.prototype._setValue_array,je.prototype._setValue_array_setNeedsUpdate,je.prototype._setValue_array_setMatrixWorldNeedsUpdate],[je.prototype._setValue_arrayElement,je.prototype._setValue_arrayElement_setNeedsUpdate,je.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[je.prototype._setValue_fromArray,je.prototype._setValue_fromArray_setNeedsUpdate,je.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var TA=new Float32Array(1);var cr=class extends za{constructor(t,e,n=1){super(t,e),this.isInstancedInterleavedBuffer=!0,this.meshPerAttribute=n}copy(t){return super.copy(t),this.meshPerAttribute=t.meshPerAttribute,this}clone(t){let e=super.clone(t);return e.meshPerAttribute=this.meshPerAttribute,e}toJSON(t){let e=super.toJSON(t);return e.isInstancedInterleavedBuffer=!0,e.meshPerAttribute=this.meshPerAttribute,e}};var Pm=new Wt,di=class{constructor(t,e,n=0,s=1/0){this.ray=new Ns(t,e),this.near=n,this.far=s,this.camera=null,this.layers=new Lo,this.params={Mesh:{},Line:{threshold:1},LOD:{},Points:{threshold:1},Sprite:{}}}set(t,e){this.ray.set(t,e)}setFromCamera(t,e){e.isPerspectiveCamera?(this.ray.origin.setFromMatrixPosition(e.matrixWorld),this.ray.direction.set(t.x,t.y,.5).unproject(e).sub(this.ray.origin).normalize(),this.camera=e):e.isOrthographicCamera?(this.ray.origin.set(t.x,t.y,e.projectionMatrix.elements[14]).unproject(e),this.ray.direction.set(0,0,-1).transformDirection(e.matrixWorld),this.camera=e):te("Raycaster: Unsupported camera type: "+e.type)}setFromXRController(t){return Pm.identity().extractRotation(t.matrixWorld),this.ray.origin.setFromMatrixPosition(t.matrixWorld),this.ray.direction.set(0,0,-1).applyMatrix4(Pm),this}intersectObject(t,e=!0,n=[]){return Ad(t,this,n,e),n.sort(Im),n}intersectObjects(t,e=!0,n=[]){for(let s=0,r=t.length;s<r;s++)Ad(t[s],this,n,e);return n.sort(Im),n}};function Im(i,t){return i.distance-t.distance}function Ad(i,t,e,n){let s=!0;if(i.layers.test(t.layers)&&i.raycast(t,e)===!1&&(s=!1),s===!0&&n===!0){let r=i.children;for(let o=0,a=r.length;o<a;o++)Ad(r[o],t,e,!0)}}var zo=class{constructor(t=1,e=0,n=0){this.radius=t,this.phi=e,this.theta=n}set(t,e,n){return this.radius=t,this.phi=e,this.theta=n,this}copy(t){return this.radius=t.radius,this.phi=t.phi,this.theta=t.theta,this}makeSafe(){return this.phi=he(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(t){return this.setFromCartesianCoords(t.x,t.y,t.z)}setFromCartesianCoords(t,e,n){return this.radius=Math.sqrt(t*t+e*e+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(t,n),this.phi=Math.acos(he(e/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var Cd=class{static{this.prototype.isMatrix2=!0}constructor(t,e,n,s){this.elements=[1,0,0,1],t!==void 0&&this.set(t,e,n,s)}identity(){return this.set(1,0,0,1),this}fromArray(t,e=0){for(let n=0;n<4;n++)this.elements[n]=t[n+e];return this}set(t,e,n,s){let r=this.elements;return r[0]=t,r[2]=e,r[1]=n,r[3]=s,this}};var Lm=new R,fc=new R,bo=new R,To=new R,gd=new R,Ky=new R,Qy=new R,il=class{constructor(t=new R,e=new R){this.start=t,this.end=e}set(t,e){return this.start.copy(t),this.end.copy(e),this}copy(t){return this.start.copy(t.start),this.end.copy(t.end),this}getCenter(t){return t.addVectors(this.start,this.end).multiplyScalar(.5)}delta(t){return t.subVectors(this.end,this.start)}distanceSq(){return this.start.distanceToSquared(this.end)}distance(){return this.start.distanceTo(this.end)}at(t,e){return this.delta(e).multiplyScalar(t).add(this.start)}closestPointToPointParameter(t,e){Lm.subVectors(t,this.start),fc.subVectors(this.end,this.start);let n=fc.dot(fc);if(n===0)return 0;let r=fc.dot(Lm)/n;return e&&(r=he(r,0,1)),r}closestPointToPoint(t,e,n){let s=this.closestPointToPointParameter(t,e);return this.delta(n).multiplyScalar(s).add(this.start)}distanceSqToLine3(t,e=Ky,n=Qy){let s=10000000000000001e-32,r,o,a=this.start,l=t.start,c=this.end,d=t.end;bo.subVectors(c,a),To.subVectors(d,l),gd.subVectors(a,l);let h=bo.dot(bo),u=To.dot(To),f=To.dot(gd);if(h<=s&&u<=s)return e.copy(a),n.copy(l),e.distanceToSquared(n);if(h<=s)r=0,o=f/u,o=he(o,0,1);else{let p=bo.dot(gd);if(u<=s)o=0,r=he(-p/h,0,1);else{let _=bo.dot(To),m=h*u-_*_;m!==0?r=he((_*f-p*u)/m,0,1):r=0,o=(_*r+f)/u,o<0?(o=0,r=he(-p/h,0,1)):o>1&&(o=1,r=he((_-p)/h,0,1))}}return e.copy(a).addScaledVector(bo,r),n.copy(l).addScaledVector(To,o),e.distanceToSquared(n)}applyMatrix4(t){return this.start.applyMatrix4(t),this.end.applyMatrix4(t),this}equals(t){return t.start.equals(this.start)&&t.end.equals(this.end)}clone(){return new this.constructor().copy(this)}};var sl=class extends ir{constructor(t,e=16776960){let n=new Uint16Array([0,1,1,2,2,3,3,0,4,5,5,6,6,7,7,4,0,4,1,5,2,6,3,7]),s=[1,1,1,-1,1,1,-1,-1,1,1,-1,1,1,1,-1,-1,1,-1,-1,-1,-1,1,-1,-1],r=new pe;r.setIndex(new Le(n,1)),r.setAttribute("position",new ie(s,3)),super(r,new Ai({color:e,toneMapped:!1})),this.box=t,this.type="Box3Helper",this.geometry.computeBoundingSphere()}updateMatrixWorld(t){let e=this.box;e.isEmpty()||(e.getCenter(this.position),e.getSize(this.scale),this.scale.multiplyScalar(.5),super.updateMatrixWorld(t))}dispose(){super.dispose(),this.geometry.dispose(),this.material.dispose()}};var Dm=new R,pc,_d,rl=class extends Ee{constructor(t=new R(0,0,1),e=new R(0,0,0),n=1,s=16776960,r=n*.2,o=r*.2){super(),this.type="ArrowHelper",pc===void 0&&(pc=new pe,pc.setAttribute("position",new ie([0,0,0,0,1,0],3)),_d=new Uo(.5,1,5,1),_d.translate(0,-.5,0)),this.position.copy(e),this.line=new ti(pc,new Ai({color:s,toneMapped:!1})),this.line.matrixAutoUpdate=!1,this.add(this.line),this.cone=new St(_d,new Vn({color:s,toneMapped:!1})),this.cone.matrixAutoUpdate=!1,this.add(this.cone),this.setDirection(t),this.setLength(n,r,o)}setDirection(t){if(t.y>.99999)this.quaternion.set(0,0,0,1);else if(t.y<-.99999)this.quaternion.set(1,0,0,0);else{Dm.set(t.z,0,-t.x).normalize();let e=Math.acos(t.y);this.quaternion.setFromAxisAngle(Dm,e)}}setLength(t,e=t*.2,n=e*.2){this.line.scale.set(1,Math.max(1e-4,t-e),1),this.line.updateMatrix(),this.cone.scale.set(n,e,n),this.cone.position.y=t,this.cone.updateMatrix()}setColor(t){this.line.material.color.set(t),this.cone.material.color.set(t)}copy(t){return super.copy(t,!1),this.line.copy(t.line),this.cone.copy(t.cone),this}dispose(){super.dispose(),this.line.geometry.dispose(),this.line.material.dispose(),this.cone.geometry.dispose(),this.cone.material.dispose()}};var Pr=class extends $i{constructor(t,e=null){super(),this.object=t,this.domElement=e,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(t){this.domElement!==null&&this.disconnect(),this.domElement=t}disconnect(){}dispose(){}update(){}};function lf(i,t,e,n){let s=tv(n);switch(e){case qd:return i*t;case th:return i*t/s.components*s.byteLength;case eh:return i*t/s.components*s.byteLength;case fr:return i*t*2/s.components*s.byteLength;case nh:return i*t*2/s.components*s.byteLength;case $d:return i*t*3/s.components*s.byteLength;case ji:return i*t*4/s.components*s.byteLength;case ih:return i*t*4/s.components*s.byteLength;case al:case ll:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*8;case cl:case hl:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case rh:case ah:return Math.max(i,16)*Math.max(t,8)/4;case sh:case oh:return Math.max(i,8)*Math.max(t,8)/2;case lh:case ch:case uh:case dh:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*8;case hh:case ul:case fh:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case ph:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case mh:return Math.floor((i+4)/5)*Math.floor((t+3)/4)*16;case gh:return Math.floor((i+4)/5)*Math.floor((t+4)/5)*16;case _h:return Math.floor((i+5)/6)*Math.floor((t+4)/5)*16;case xh:return Math.floor((i+5)/6)*Math.floor((t+5)/6)*16;case yh:return Math.floor((i+7)/8)*Math.floor((t+4)/5)*16;case vh:return Math.floor((i+7)/8)*Math.floor((t+5)/6)*16;case Sh:return Math.floor((i+7)/8)*Math.floor((t+7)/8)*16;case Mh:return Math.floor((i+9)/10)*Math.floor((t+4)/5)*16;case wh:return Math.floor((i+9)/10)*Math.floor((t+5)/6)*16;case bh:return Math.floor((i+9)/10)*Math.floor((t+7)/8)*16;case Th:return Math.floor((i+9)/10)*Math.floor((t+9)/10)*16;case Eh:return Math.floor((i+11)/12)*Math.floor((t+9)/10)*16;case Ah:return Math.floor((i+11)/12)*Math.floor((t+11)/12)*16;case Ch:case Rh:case Ph:return Math.ceil(i/4)*Math.ceil(t/4)*16;case Ih:case Lh:return Math.ceil(i/4)*Math.ceil(t/4)*8;case dl:case Dh:return Math.ceil(i/4)*Math.ceil(t/4)*16}throw new Error(`Unable to determine texture byte length for ${e} format.`)}function tv(i){switch(i){case _i:case Hd:return{byteLength:1,components:1};case Wo:case Wd:case Ji:return{byteLength:2,components:1};case Kc:case Qc:return{byteLength:2,components:4};case Zi:case jc:case Fi:return{byteLength:4,components:1};case Xd:case Yd:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${i}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:"187"}}));typeof window<"u"&&(window.__THREE__?jt("WARNING: Multiple instances of Three.js being imported."):window.__THREE__="187");function Vg(){let i=null,t=!1,e=null,n=null;function s(r,o){n=i.requestAnimationFrame(s),e(r,o)}return{start:function(){t!==!0&&e!==null&&i!==null&&(n=i.requestAnimationFrame(s),t=!0)},stop:function(){i!==null&&i.cancelAnimationFrame(n),t=!1},setAnimationLoop:function(r){e=r},setContext:function(r){i=r}}}function nv(i){let t=new WeakMap;function e(a,l){let c=a.array,d=a.usage,h=c.byteLength,u=i.createBuffer();i.bindBuffer(l,u),i.bufferData(l,c,d),a.onUploadCallback();let f;if(c instanceof Float32Array)f=i.FLOAT;else if(typeof Float16Array<"u"&&c instanceof Float16Array)f=i.HALF_FLOAT;else if(c instanceof Uint16Array)a.isFloat16BufferAttribute?f=i.HALF_FLOAT:f=i.UNSIGNED_SHORT;else if(c instanceof Int16Array)f=i.SHORT;else if(c instanceof Uint32Array)f=i.UNSIGNED_INT;else if(c instanceof Int32Array)f=i.INT;else if(c instanceof Int8Array)f=i.BYTE;else if(c instanceof Uint8Array)f=i.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)f=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:u,type:f,bytesPerElement:c.BYTES_PER_ELEMENT,version:a.version,size:h}}function n(a,l,c){let d=l.array,h=l.updateRanges;if(i.bindBuffer(c,a),h.length===0)i.bufferSubData(c,0,d);else{h.sort((f,p)=>f.start-p.start);let u=0;for(let f=1;f<h.length;f++){let p=h[u],_=h[f];_.start<=p.start+p.count+1?p.count=Math.max(p.count,_.start+_.count-p.start):(++u,h[u]=_)}h.length=u+1;for(let f=0,p=h.length;f<p;f++){let _=h[f];i.bufferSubData(c,_.start*d.BYTES_PER_ELEMENT,d,_.start,_.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(a){return a.isInterleavedBufferAttribute&&(a=a.data),t.get(a)}function r(a){a.isInterleavedBufferAttribute&&(a=a.data);let l=t.get(a);l&&(i.deleteBuffer(l.buffer),t.delete(a))}function o(a,l){if(a.isInterleavedBufferAttribute&&(a=a.data),a.isGLBufferAttribute){let d=t.get(a);(!d||d.version<a.version)&&t.set(a,{buffer:a.buffer,type:a.type,bytesPerElement:a.elementSize,version:a.version});return}let c=t.get(a);if(c===void 0)t.set(a,e(a,l));else if(c.version<a.version){if(c.size!==a.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(c.buffer,a,l),c.version=a.version}}return{get:s,remove:r,update:o}}var iv=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,sv=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,rv=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,ov=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,av=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,lv=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,cv=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,hv=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,uv=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,dv=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,fv=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,pv=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,mv=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,gv=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,_v=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,xv=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,yv=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,vv=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,Sv=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,Mv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,wv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,bv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,Tv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,Ev=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,Av=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,Cv=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,Rv=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,Pv=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,Iv=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,Lv="gl_FragColor = linearToOutputTexel( gl_FragColor );",Dv=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,Nv=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,Ov=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,Uv=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,Fv=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,Bv=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,kv=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,zv=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,Vv=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,Gv=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,Hv=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,Wv=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,Xv=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,Yv=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,qv=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,$v=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,Zv=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,Jv=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,jv=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,Kv=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,Qv=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,tS=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,eS=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,nS=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,iS=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,sS=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,rS=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,oS=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,aS=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,lS=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,cS=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,hS=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,uS=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,dS=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,fS=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,pS=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,mS=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,gS=`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,_S=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,xS=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,yS=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,vS=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,SS=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,MS=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,wS=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,bS=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,TS=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,ES=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,AS=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,CS=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,RS=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,PS=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,IS=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,LS=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,DS=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,NS=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,OS=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,US=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,FS=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,BS=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,kS=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,zS=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,VS=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,GS=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,HS=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,WS=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,XS=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,YS=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,qS=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,$S=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,ZS=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,JS=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,jS=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,KS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,QS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,tM=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,eM=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,nM=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,iM=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,sM=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,rM=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,oM=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,aM=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,lM=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,cM=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,hM=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,uM=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,dM=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,fM=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,pM=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,mM=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,gM=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,_M=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,xM=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,yM=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,vM=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,SM=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,MM=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,wM=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,bM=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,TM=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,EM=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,AM=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,CM=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,RM=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,PM=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,IM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,LM=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,DM=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,NM=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,OM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,me={alphahash_fragment:iv,alphahash_pars_fragment:sv,alphamap_fragment:rv,alphamap_pars_fragment:ov,alphatest_fragment:av,alphatest_pars_fragment:lv,aomap_fragment:cv,aomap_pars_fragment:hv,batching_pars_vertex:uv,batching_vertex:dv,begin_vertex:fv,beginnormal_vertex:pv,bsdfs:mv,iridescence_fragment:gv,bumpmap_pars_fragment:_v,clipping_planes_fragment:xv,clipping_planes_pars_fragment:yv,clipping_planes_pars_vertex:vv,clipping_planes_vertex:Sv,color_fragment:Mv,color_pars_fragment:wv,color_pars_vertex:bv,color_vertex:Tv,common:Ev,defaultnormal_vertex:Av,displacementmap_pars_vertex:Cv,displacementmap_vertex:Rv,emissivemap_fragment:Pv,emissivemap_pars_fragment:Iv,colorspace_fragment:Lv,colorspace_pars_fragment:Dv,envmap_fragment:Nv,envmap_common_pars_fragment:Ov,envmap_pars_fragment:Uv,envmap_pars_vertex:Fv,envmap_physical_pars_fragment:$v,envmap_vertex:Bv,fog_vertex:kv,fog_pars_vertex:zv,fog_fragment:Vv,fog_pars_fragment:Gv,gradientmap_pars_fragment:Hv,lightmap_pars_fragment:Wv,lights_lambert_fragment:Xv,lights_lambert_pars_fragment:Yv,lights_pars_begin:qv,lights_toon_fragment:Zv,lights_toon_pars_fragment:Jv,lights_phong_fragment:jv,lights_phong_pars_fragment:Kv,lights_physical_fragment:Qv,lights_physical_pars_fragment:tS,lights_fragment_begin:eS,lights_fragment_maps:nS,lights_fragment_end:iS,lightprobes_pars_fragment:sS,logdepthbuf_fragment:rS,logdepthbuf_pars_fragment:oS,logdepthbuf_pars_vertex:aS,logdepthbuf_vertex:lS,map_fragment:cS,map_pars_fragment:hS,map_particle_fragment:uS,map_particle_pars_fragment:dS,metalnessmap_fragment:fS,metalnessmap_pars_fragment:pS,morphinstance_vertex:mS,morphcolor_vertex:gS,morphnormal_vertex:_S,morphtarget_pars_vertex:xS,morphtarget_vertex:yS,normal_fragment_begin:vS,normal_fragment_maps:SS,normal_pars_fragment:MS,normal_pars_vertex:wS,normal_vertex:bS,normalmap_pars_fragment:TS,clearcoat_normal_fragment_begin:ES,clearcoat_normal_fragment_maps:AS,clearcoat_pars_fragment:CS,iridescence_pars_fragment:RS,opaque_fragment:PS,packing:IS,premultiplied_alpha_fragment:LS,project_vertex:DS,dithering_fragment:NS,dithering_pars_fragment:OS,roughnessmap_fragment:US,roughnessmap_pars_fragment:FS,shadowmap_pars_fragment:BS,shadowmap_pars_vertex:kS,shadowmap_vertex:zS,shadowmask_pars_fragment:VS,skinbase_vertex:GS,skinning_pars_vertex:HS,skinning_vertex:WS,skinnormal_vertex:XS,specularmap_fragment:YS,specularmap_pars_fragment:qS,tonemapping_fragment:$S,tonemapping_pars_fragment:ZS,transmission_fragment:JS,transmission_pars_fragment:jS,uv_pars_fragment:KS,uv_pars_vertex:QS,uv_vertex:tM,worldpos_vertex:eM,background_vert:nM,background_frag:iM,backgroundCube_vert:sM,backgroundCube_frag:rM,cube_vert:oM,cube_frag:aM,depth_vert:lM,depth_frag:cM,distance_vert:hM,distance_frag:uM,equirect_vert:dM,equirect_frag:fM,linedashed_vert:pM,linedashed_frag:mM,meshbasic_vert:gM,meshbasic_frag:_M,meshlambert_vert:xM,meshlambert_frag:yM,meshmatcap_vert:vM,meshmatcap_frag:SM,meshnormal_vert:MM,meshnormal_frag:wM,meshphong_vert:bM,meshphong_frag:TM,meshphysical_vert:EM,meshphysical_frag:AM,meshtoon_vert:CM,meshtoon_frag:RM,points_vert:PM,points_frag:IM,shadow_vert:LM,shadow_frag:DM,sprite_vert:NM,sprite_frag:OM},It={common:{diffuse:{value:new Xt(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new re},alphaMap:{value:null},alphaMapTransform:{value:new re},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new re}},envmap:{envMap:{value:null},envMapRotation:{value:new re},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new re}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new re}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new re},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new re},normalScale:{value:new Bt(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new re},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new re}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new re}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new re}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new Xt(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new Xt(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new re},alphaTest:{value:0},uvTransform:{value:new re}},sprite:{diffuse:{value:new Xt(16777215)},opacity:{value:1},center:{value:new Bt(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new re},alphaMap:{value:null},alphaMapTransform:{value:new re},alphaTest:{value:0}}},fi={basic:{uniforms:ei([It.common,It.specularmap,It.envmap,It.aomap,It.lightmap,It.fog]),vertexShader:me.meshbasic_vert,fragmentShader:me.meshbasic_frag},lambert:{uniforms:ei([It.common,It.specularmap,It.envmap,It.aomap,It.lightmap,It.emissivemap,It.bumpmap,It.normalmap,It.displacementmap,It.fog,It.lights,{emissive:{value:new Xt(0)},envMapIntensity:{value:1}}]),vertexShader:me.meshlambert_vert,fragmentShader:me.meshlambert_frag},phong:{uniforms:ei([It.common,It.specularmap,It.envmap,It.aomap,It.lightmap,It.emissivemap,It.bumpmap,It.normalmap,It.displacementmap,It.fog,It.lights,{emissive:{value:new Xt(0)},specular:{value:new Xt(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:me.meshphong_vert,fragmentShader:me.meshphong_frag},standard:{uniforms:ei([It.common,It.envmap,It.aomap,It.lightmap,It.emissivemap,It.bumpmap,It.normalmap,It.displacementmap,It.roughnessmap,It.metalnessmap,It.fog,It.lights,{emissive:{value:new Xt(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:me.meshphysical_vert,fragmentShader:me.meshphysical_frag},toon:{uniforms:ei([It.common,It.aomap,It.lightmap,It.emissivemap,It.bumpmap,It.normalmap,It.displacementmap,It.gradientmap,It.fog,It.lights,{emissive:{value:new Xt(0)}}]),vertexShader:me.meshtoon_vert,fragmentShader:me.meshtoon_frag},matcap:{uniforms:ei([It.common,It.bumpmap,It.normalmap,It.displacementmap,It.fog,{matcap:{value:null}}]),vertexShader:me.meshmatcap_vert,fragmentShader:me.meshmatcap_frag},points:{uniforms:ei([It.points,It.fog]),vertexShader:me.points_vert,fragmentShader:me.points_frag},dashed:{uniforms:ei([It.common,It.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:me.linedashed_vert,fragmentShader:me.linedashed_frag},depth:{uniforms:ei([It.common,It.displacementmap]),vertexShader:me.depth_vert,fragmentShader:me.depth_frag},normal:{uniforms:ei([It.common,It.bumpmap,It.normalmap,It.displacementmap,{opacity:{value:1}}]),vertexShader:me.meshnormal_vert,fragmentShader:me.meshnormal_frag},sprite:{uniforms:ei([It.sprite,It.fog]),vertexShader:me.sprite_vert,fragmentShader:me.sprite_frag},background:{uniforms:{uvTransform:{value:new re},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:me.background_vert,fragmentShader:me.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new re}},vertexShader:me.backgroundCube_vert,fragmentShader:me.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:me.cube_vert,fragmentShader:me.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:me.equirect_vert,fragmentShader:me.equirect_frag},distance:{uniforms:ei([It.common,It.displacementmap,{referencePosition:{value:new R},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:me.distance_vert,fragmentShader:me.distance_frag},shadow:{uniforms:ei([It.lights,It.fog,{color:{value:new Xt(0)},opacity:{value:1}}]),vertexShader:me.shadow_vert,fragmentShader:me.shadow_frag}};fi.physical={uniforms:ei([fi.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new re},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new re},clearcoatNormalScale:{value:new Bt(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new re},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new re},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new re},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new re},sheen:{value:0},sheenColor:{value:new Xt(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new re},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new re},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new re},transmissionSamplerSize:{value:new Bt},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new re},attenuationDistance:{value:0},attenuationColor:{value:new Xt(0)},specularColor:{value:new Xt(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new re},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new re},anisotropyVector:{value:new Bt},anisotropyMap:{value:null},anisotropyMapTransform:{value:new re}}]),vertexShader:me.meshphysical_vert,fragmentShader:me.meshphysical_frag};var Oh={r:0,b:0,g:0},UM=new Wt,Gg=new re;Gg.set(-1,0,0,0,1,0,0,0,1);function FM(i,t,e,n,s,r){let o=new Xt(0),a=s===!0?0:1,l,c,d=null,h=0,u=null;function f(y){let T=y.isScene===!0?y.background:null;if(T&&T.isTexture){let v=y.backgroundBlurriness>0;T=t.get(T,v)}return T}function p(y){let T=!1,v=f(y);v===null?m(o,a):v&&v.isColor&&(m(v,1),T=!0);let M=i.xr.getEnvironmentBlendMode();M==="additive"?e.buffers.color.setClear(0,0,0,1,r):M==="alpha-blend"&&e.buffers.color.setClear(0,0,0,0,r),(i.autoClear||T)&&(e.buffers.depth.setTest(!0),e.buffers.depth.setMask(!0),e.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function _(y,T){let v=f(T);v&&v.isCubeTexture?(c===void 0&&(c=new St(new Ye(1,1,1),new ui({name:"BackgroundCubeMaterial",uniforms:Ur(fi.backgroundCube.uniforms),vertexShader:fi.backgroundCube.vertexShader,fragmentShader:fi.backgroundCube.fragmentShader,side:Yn,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),c.geometry.deleteAttribute("uv"),c.onBeforeRender=function(M,b,x){this.matrixWorld.copyPosition(x.matrixWorld)},Object.defineProperty(c.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),n.update(c)),c.material.uniforms.envMap.value=v,c.material.uniforms.backgroundBlurriness.value=T.backgroundBlurriness,c.material.uniforms.backgroundIntensity.value=T.backgroundIntensity,c.material.uniforms.backgroundRotation.value.setFromMatrix4(UM.makeRotationFromEuler(T.backgroundRotation)).transpose(),v.isRenderTargetTexture===!1&&c.material.uniforms.backgroundRotation.value.premultiply(Gg),c.material.toneMapped=Se.getTransfer(v.colorSpace)!==Ie,(d!==v||h!==v.version||u!==i.toneMapping)&&(c.material.needsUpdate=!0,d=v,h=v.version,u=i.toneMapping),c.layers.enableAll(),y.unshift(c,c.geometry,c.material,0,0,null)):v&&v.isTexture&&(l===void 0&&(l=new St(new gi(2,2),new ui({name:"BackgroundMaterial",uniforms:Ur(fi.background.uniforms),vertexShader:fi.background.vertexShader,fragmentShader:fi.background.fragmentShader,side:dr,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute("normal"),Object.defineProperty(l.material,"map",{get:function(){return this.uniforms.t2D.value}}),n.update(l)),l.material.uniforms.t2D.value=v,l.material.uniforms.backgroundIntensity.value=T.backgroundIntensity,l.material.toneMapped=Se.getTransfer(v.colorSpace)!==Ie,v.matrixAutoUpdate===!0&&v.updateMatrix(),l.material.uniforms.uvTransform.value.copy(v.matrix),(d!==v||h!==v.version||u!==i.toneMapping)&&(l.material.needsUpdate=!0,d=v,h=v.version,u=i.toneMapping),l.layers.enableAll(),y.unshift(l,l.geometry,l.material,0,0,null))}function m(y,T){y.getRGB(Oh,rf(i)),e.buffers.color.setClear(Oh.r,Oh.g,Oh.b,T,r)}function g(){c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0),l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0)}return{getClearColor:function(){return o},setClearColor:function(y,T=1){o.set(y),a=T,m(o,a)},getClearAlpha:function(){return a},setClearAlpha:function(y){a=y,m(o,a)},render:p,addToRenderList:_,dispose:g}}function BM(i,t){let e=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=u(null),r=s,o=!1;function a(L,B,G,D,X){let Z=!1,W=h(L,D,G,B);r!==W&&(r=W,c(r.object)),Z=f(L,D,G,X),Z&&p(L,D,G,X),X!==null&&t.update(X,i.ELEMENT_ARRAY_BUFFER),(Z||o)&&(o=!1,v(L,B,G,D),X!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,t.get(X).buffer))}function l(){return i.createVertexArray()}function c(L){return i.bindVertexArray(L)}function d(L){return i.deleteVertexArray(L)}function h(L,B,G,D){let X=D.wireframe===!0,Z=n[B.id];Z===void 0&&(Z={},n[B.id]=Z);let W=L.isInstancedMesh===!0?L.id:0,at=Z[W];at===void 0&&(at={},Z[W]=at);let k=at[G.id];k===void 0&&(k={},at[G.id]=k);let q=k[X];return q===void 0&&(q=u(l()),k[X]=q),q}function u(L){let B=[],G=[],D=[];for(let X=0;X<e;X++)B[X]=0,G[X]=0,D[X]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:B,enabledAttributes:G,attributeDivisors:D,object:L,attributes:{},index:null}}function f(L,B,G,D){let X=r.attributes,Z=B.attributes,W=0,at=G.getAttributes();for(let k in at)if(at[k].location>=0){let Q=X[k],lt=Z[k];if(lt===void 0&&(k==="instanceMatrix"&&L.instanceMatrix&&(lt=L.instanceMatrix),k==="instanceColor"&&L.instanceColor&&(lt=L.instanceColor)),Q===void 0||Q.attribute!==lt||lt&&Q.data!==lt.data)return!0;W++}return r.attributesNum!==W||r.index!==D}function p(L,B,G,D){let X={},Z=B.attributes,W=0,at=G.getAttributes();for(let k in at)if(at[k].location>=0){let Q=Z[k];Q===void 0&&(k==="instanceMatrix"&&L.instanceMatrix&&(Q=L.instanceMatrix),k==="instanceColor"&&L.instanceColor&&(Q=L.instanceColor));let lt={};lt.attribute=Q,Q&&Q.data&&(lt.data=Q.data),X[k]=lt,W++}r.attributes=X,r.attributesNum=W,r.index=D}function _(){let L=r.newAttributes;for(let B=0,G=L.length;B<G;B++)L[B]=0}function m(L){g(L,0)}function g(L,B){let G=r.newAttributes,D=r.enabledAttributes,X=r.attributeDivisors;G[L]=1,D[L]===0&&(i.enableVertexAttribArray(L),D[L]=1),X[L]!==B&&(i.vertexAttribDivisor(L,B),X[L]=B)}function y(){let L=r.newAttributes,B=r.enabledAttributes;for(let G=0,D=B.length;G<D;G++)B[G]!==L[G]&&(i.disableVertexAttribArray(G),B[G]=0)}function T(L,B,G,D,X,Z,W){W===!0?i.vertexAttribIPointer(L,B,G,X,Z):i.vertexAttribPointer(L,B,G,D,X,Z)}function v(L,B,G,D){_();let X=D.attributes,Z=G.getAttributes(),W=B.defaultAttributeValues;for(let at in Z){let k=Z[at];if(k.location>=0){let q=X[at];if(q===void 0&&(at==="instanceMatrix"&&L.instanceMatrix&&(q=L.instanceMatrix),at==="instanceColor"&&L.instanceColor&&(q=L.instanceColor)),q!==void 0){let Q=q.normalized,lt=q.itemSize,ht=t.get(q);if(ht===void 0)continue;let et=ht.buffer,mt=ht.type,xt=ht.bytesPerElement,Ct=mt===i.INT||mt===i.UNSIGNED_INT||q.gpuType===jc;if(q.isInterleavedBufferAttribute){let wt=q.data,$t=wt.isInterleavedBuffer===!0?wt.stride:wt.itemSize,le=q.offset;if(wt.isInstancedInterleavedBuffer||wt.isInstancedBufferAttribute){for(let Yt=0;Yt<k.locationSize;Yt++)g(k.location+Yt,wt.meshPerAttribute);L.isInstancedMesh!==!0&&D._maxInstanceCount===void 0&&(D._maxInstanceCount=wt.meshPerAttribute*wt.count)}else for(let Yt=0;Yt<k.locationSize;Yt++)m(k.location+Yt);i.bindBuffer(i.ARRAY_BUFFER,et);for(let Yt=0;Yt<k.locationSize;Yt++)T(k.location+Yt,lt/k.locationSize,mt,Q,$t*xt,(le+lt/k.locationSize*Yt)*xt,Ct)}else{if(q.isInstancedBufferAttribute){for(let wt=0;wt<k.locationSize;wt++)g(k.location+wt,q.meshPerAttribute);L.isInstancedMesh!==!0&&D._maxInstanceCount===void 0&&(D._maxInstanceCount=q.meshPerAttribute*q.count)}else for(let wt=0;wt<k.locationSize;wt++)m(k.location+wt);i.bindBuffer(i.ARRAY_BUFFER,et);for(let wt=0;wt<k.locationSize;wt++)T(k.location+wt,lt/k.locationSize,mt,Q,lt*xt,lt/k.locationSize*wt*xt,Ct)}}else if(W!==void 0){let Q=W[at];if(Q!==void 0)switch(Q.length){case 2:i.vertexAttrib2fv(k.location,Q);break;case 3:i.vertexAttrib3fv(k.location,Q);break;case 4:i.vertexAttrib4fv(k.location,Q);break;default:i.vertexAttrib1fv(k.location,Q)}}}}y()}function M(){O();for(let L in n){let B=n[L];for(let G in B){let D=B[G];for(let X in D){let Z=D[X];for(let W in Z)d(Z[W].object),delete Z[W];delete D[X]}}delete n[L]}}function b(L){if(n[L.id]===void 0)return;let B=n[L.id];for(let G in B){let D=B[G];for(let X in D){let Z=D[X];for(let W in Z)d(Z[W].object),delete Z[W];delete D[X]}}delete n[L.id]}function x(L){for(let B in n){let G=n[B];for(let D in G){let X=G[D];if(X[L.id]===void 0)continue;let Z=X[L.id];for(let W in Z)d(Z[W].object),delete Z[W];delete X[L.id]}}}function w(L){for(let B in n){let G=n[B],D=L.isInstancedMesh===!0?L.id:0,X=G[D];if(X!==void 0){for(let Z in X){let W=X[Z];for(let at in W)d(W[at].object),delete W[at];delete X[Z]}delete G[D],Object.keys(G).length===0&&delete n[B]}}}function O(){P(),o=!0,r!==s&&(r=s,c(r.object))}function P(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:a,reset:O,resetDefaultState:P,dispose:M,releaseStatesOfGeometry:b,releaseStatesOfObject:w,releaseStatesOfProgram:x,initAttributes:_,enableAttribute:m,disableUnusedAttributes:y}}function kM(i,t,e){let n;function s(l){n=l}function r(l,c){i.drawArrays(n,l,c),e.update(c,n,1)}function o(l,c,d){d!==0&&(i.drawArraysInstanced(n,l,c,d),e.update(c,n,d))}function a(l,c,d){if(d===0)return;t.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,l,0,c,0,d);let u=0;for(let f=0;f<d;f++)u+=c[f];e.update(u,n,1)}this.setMode=s,this.render=r,this.renderInstances=o,this.renderMultiDraw=a}function zM(i,t,e,n){let s;function r(){if(s!==void 0)return s;if(t.has("EXT_texture_filter_anisotropic")===!0){let x=t.get("EXT_texture_filter_anisotropic");s=i.getParameter(x.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function o(x){return!(x!==ji&&n.convert(x)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function a(x){let w=x===Ji&&(t.has("EXT_color_buffer_half_float")||t.has("EXT_color_buffer_float"));return!(x!==_i&&x!==Fi&&!w&&n.convert(x)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE))}function l(x){if(x==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";x="mediump"}return x==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=e.precision!==void 0?e.precision:"highp",d=l(c);d!==c&&(jt("WebGLRenderer:",c,"not supported, using",d,"instead."),c=d);let h=e.reversedDepthBuffer===!0&&t.has("EXT_clip_control"),u=e.logarithmicDepthBuffer===!0&&h===!1;e.reversedDepthBuffer===!0&&h===!1&&jt("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),e.logarithmicDepthBuffer===!0&&h===!0&&jt("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let f=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),p=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),_=i.getParameter(i.MAX_TEXTURE_SIZE),m=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),g=i.getParameter(i.MAX_VERTEX_ATTRIBS),y=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),T=i.getParameter(i.MAX_VARYING_VECTORS),v=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),M=i.getParameter(i.MAX_SAMPLES),b=i.getParameter(i.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:o,textureTypeReadable:a,precision:c,logarithmicDepthBuffer:u,reversedDepthBuffer:h,maxTextures:f,maxVertexTextures:p,maxTextureSize:_,maxCubemapSize:m,maxAttributes:g,maxVertexUniforms:y,maxVaryings:T,maxFragmentUniforms:v,maxSamples:M,samples:b}}function VM(i){let t=this,e=null,n=0,s=!1,r=!1,o=new En,a=new re,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(h,u){let f=h.length!==0||u||n!==0||s;return s=u,n=h.length,f},this.beginShadows=function(){r=!0,d(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(h,u){e=d(h,u,0)},this.setState=function(h,u,f){let p=h.clippingPlanes,_=h.clipIntersection,m=h.clipShadows,g=i.get(h);if(!s||p===null||p.length===0||r&&!m)r?d(null):c();else{let y=r?0:n,T=y*4,v=g.clippingState||null;l.value=v,v=d(p,u,T,f);for(let M=0;M!==T;++M)v[M]=e[M];g.clippingState=v,this.numIntersection=_?this.numPlanes:0,this.numPlanes+=y}};function c(){l.value!==e&&(l.value=e,l.needsUpdate=n>0),t.numPlanes=n,t.numIntersection=0}function d(h,u,f,p){let _=h!==null?h.length:0,m=null;if(_!==0){if(m=l.value,p!==!0||m===null){let g=f+_*4,y=u.matrixWorldInverse;a.getNormalMatrix(y),(m===null||m.length<g)&&(m=new Float32Array(g));for(let T=0,v=f;T!==_;++T,v+=4)o.copy(h[T]).applyMatrix4(y,a),o.normal.toArray(m,v),m[v+3]=o.constant}l.value=m,l.needsUpdate=!0}return t.numPlanes=_,t.numIntersection=0,m}}var xl=class extends Xn{constructor(t=1,e={}){super(t,t,e),this.isWebGLCubeRenderTarget=!0;let n={width:t,height:t,depth:1},s=[n,n,n,n,n,n];this.texture=new Ga(s),this._setTextureOptions(e),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(t,e){this.texture.type=e.type,this.texture.colorSpace=e.colorSpace,this.texture.generateMipmaps=e.generateMipmaps,this.texture.minFilter=e.minFilter,this.texture.magFilter=e.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new Ye(5,5,5),r=new ui({name:"CubemapFromEquirect",uniforms:Ur(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:Yn,blending:Lr});r.uniforms.tEquirect.value=e;let o=new St(s,r),a=e.minFilter;return e.minFilter===ks&&(e.minFilter=ci),new ko(1,10,this).update(t,o),e.minFilter=a,o.geometry.dispose(),o.material.dispose(),this}clear(t,e=!0,n=!0,s=!0){let r=t.getRenderTarget();for(let o=0;o<6;o++)t.setRenderTarget(this,o),t.clear(e,n,s);t.setRenderTarget(r)}},vg=256,GM=3,HM=20,Hg=256,Wg=16,WM=3,XM=new R,YM=new Xt,Fh=class i{constructor(t){this._renderer=t,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new ko(1,10,null),this._boxMesh=new St(new Ye(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(t,e=0,n=.1,s=100,r={}){let{size:o=256,position:a=XM}=r,l=this._renderer;this._setSize(o);let c=this._allocateTarget(),d=this._getSourceTarget(!0);e>0&&(d.texture.mipmapsAutoUpdate=!1);let h=l.autoClear,u=l.autoClearColor,f=l.autoClearDepth,p=l.autoClearStencil,_=t.background;l.autoClear=!0,l.autoClearColor=!0,l.autoClearDepth=!0,l.autoClearStencil=!0,_===null&&(t.background=l.getClearColor(YM));let m=new ko(n,s,d);return m.position.copy(a),m.update(l,t),l.autoClear=h,l.autoClearColor=u,l.autoClearDepth=f,l.autoClearStencil=p,t.background=_,e>0&&(d.texture.mipmapsAutoUpdate=!0,this._blur(c,e)),this._applyPMREM(c),c}fromEquirectangular(t,e=null){return this._fromTexture(t,e)}fromCubemap(t,e=null){return this._fromTexture(t,e)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=wg(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=Mg(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(t,e){return e>0?1-Math.sqrt(1-t/e):0}_setSize(t){this._cubeSize=Math.max(vg,ef(t))}_fromTexture(t,e){t.mapping===Nr||t.mapping===Ho?this._setSize(t.image.length===0?vg:t.image[0].width||t.image[0].image.width):this._setSize(t.image.width/4);let n=e||this._allocateTarget();return this._textureToCubemap(t),this._applyPMREM(n),n}_allocateTarget(){let t=this._cubeSize,e=Sg(t,!1,!1),n=Math.log2(t)-GM;for(let s=0;s<=n;s++)e.texture.mipmaps.push({width:t>>s,height:t>>s});return e.texture.name="PMREM",e.texture.isPMREMTexture=!0,e}_getSourceTarget(t=!1){let e=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==e||t&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=Sg(e,!0,t)),this._sourceTarget}_compileMaterial(t){this._boxMesh.material=t,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(t,e,n){let s=this._boxMesh,r=this._cubeCamera;s.material=n,r.renderTarget=t,r.activeMipmapLevel=e;let o=t.width>>e;t.viewport.set(0,0,o,o),r.update(this._renderer,s),t.viewport.set(0,0,t.width,t.height)}_textureToCubemap(t){let e;t.mapping===Nr||t.mapping===Ho?(this._cubemapMaterial===null&&(this._cubemapMaterial=wg()),e=this._cubemapMaterial,e.uniforms.flipEnvMap.value=t.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=Mg()),e=this._equirectMaterial),e.uniforms.envMap.value=t,this._renderCube(this._getSourceTarget(),0,e)}_applyPMREM(t){this._ggxMaterial===null&&(this._ggxMaterial=qM(),this._integrationMaterial=$M());let e=this._cubeSize,n=t.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;let r=this._integrationMaterial.uniforms;r.envMap.value=this._sourceTarget.texture,r.sourceLod.value=Math.log2(e/Wg);for(let o=0;o<=n;o++){let a=i.lodToRoughness(o,n);if(o>n-WM)r.roughness.value=a,this._renderCube(t,o,this._integrationMaterial);else{let l=a>0?Math.log2(e)+.5*Math.log2(6/(Hg*Math.pow(a,4)))+.5:0;s.roughness.value=a,s.lodBias.value=l,this._renderCube(t,o,this._ggxMaterial)}}}_blur(t,e){this._blurMaterial===null&&(this._blurMaterial=ZM());let n=this._blurMaterial,s=n.uniforms,r=this._sourceTarget;s.sigma.value=Math.min(e,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this._renderCube(t,0,n),s.envMap.value=t.texture,this._renderCube(r,0,n)}};function Sg(i,t,e){return new xl(i,{minFilter:ks,generateMipmaps:t,type:Ji,colorSpace:Ia,depthBuffer:e})}function yl(i,t,e){return new ui({name:i,uniforms:t,vertexShader:me.cube_vert,fragmentShader:e,side:Yn,blending:Lr,depthTest:!1,depthWrite:!1})}function qM(){return yl("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${Hg}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function $M(){return yl("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:Wg}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function ZM(){return yl("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${HM}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function Mg(){return yl("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function wg(){return yl("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function JM(i){let t=new WeakMap,e=new WeakMap,n=null;function s(u,f=!1){return u==null?null:f?o(u):r(u)}function r(u){if(u&&u.isTexture){let f=u.mapping;if(f===$c||f===Zc)if(t.has(u)){let p=t.get(u).texture;return a(p,u.mapping)}else{let p=u.image;if(p&&p.height>0){let _=new xl(p.height);return _.fromEquirectangularTexture(i,u),t.set(u,_),u.addEventListener("dispose",c),a(_.texture,u.mapping)}else return null}}return u}function o(u){if(u&&u.isTexture&&u.isPMREMTexture!==!0){let f=u.mapping,p=f===$c||f===Zc,_=f===Nr||f===Ho;if(p||_){let m=e.get(u),g=m!==void 0?m.texture.pmremVersion:0;if(u.isRenderTargetTexture&&u.pmremVersion!==g)return n===null&&(n=new Fh(i)),m=p?n.fromEquirectangular(u,m):n.fromCubemap(u,m),m.texture.pmremVersion=u.pmremVersion,e.set(u,m),m.texture;if(m!==void 0)return m.texture;{let y=u.image;return p&&y&&y.height>0||_&&y&&l(y)?(n===null&&(n=new Fh(i)),m=p?n.fromEquirectangular(u):n.fromCubemap(u),m.texture.pmremVersion=u.pmremVersion,e.set(u,m),u.addEventListener("dispose",d),m.texture):null}}}return u}function a(u,f){return f===$c?u.mapping=Nr:f===Zc&&(u.mapping=Ho),u}function l(u){let f=0,p=6;for(let _=0;_<p;_++)u[_]!==void 0&&f++;return f===p}function c(u){let f=u.target;f.removeEventListener("dispose",c);let p=t.get(f);p!==void 0&&(t.delete(f),p.dispose())}function d(u){let f=u.target;f.removeEventListener("dispose",d);let p=e.get(f);p!==void 0&&(e.delete(f),p.dispose())}function h(){t=new WeakMap,e=new WeakMap,n!==null&&(n.dispose(),n=null)}return{get:s,dispose:h}}function jM(i){let t={};function e(n){if(t[n]!==void 0)return t[n];let s=i.getExtension(n);return t[n]=s,s}return{has:function(n){return e(n)!==null},init:function(){e("EXT_color_buffer_float"),e("WEBGL_clip_cull_distance"),e("OES_texture_float_linear"),e("EXT_color_buffer_half_float"),e("WEBGL_multisampled_render_to_texture"),e("WEBGL_render_shared_exponent")},get:function(n){let s=e(n);return s===null&&Aa("WebGLRenderer: "+n+" extension not supported."),s}}}function KM(i,t,e,n){let s={},r=new WeakMap,o=new FinalizationRegistry(p=>delete s[p]);function a(p){l(p.target)}function l(p){p.index!==null&&t.remove(p.index);for(let m in p.attributes)t.remove(p.attributes[m]);p.removeEventListener("dispose",a),delete s[p.id],o.unregister(p);let _=r.get(p);_&&(t.remove(_),r.delete(p)),n.releaseStatesOfGeometry(p),p.isInstancedBufferGeometry===!0&&delete p._maxInstanceCount,e.memory.geometries--}function c(p,_){return s[_.id]!==void 0||(_.addEventListener("dispose",a),s[_.id]=new WeakRef(_),o.register(_,_.id,_),e.memory.geometries++),_}function d(p){let _=p.attributes;for(let m in _)t.update(_[m],i.ARRAY_BUFFER)}function h(p){let _=p.index,m=p.attributes.position,g=0;if(m===void 0)return;let y=_!==null?_.array.length:m.array.length/3-1,T=m.count>=65535?ka:Ba,v=new T(Math.ceil(y/3)*6,1),M=v.array;if(_!==null){let x=_.array;g=_.version;for(let w=0,O=0;w<y;w+=3){let P=x[w+0],L=x[w+1],B=x[w+2];M[O++]=P,M[O++]=L,M[O++]=L,M[O++]=B,M[O++]=B,M[O++]=P}}else{g=m.version;for(let x=0,w=0;x<y;x+=3){let O=x+0,P=x+1,L=x+2;M[w++]=O,M[w++]=P,M[w++]=P,M[w++]=L,M[w++]=L,M[w++]=O}}v.version=g;let b=r.get(p);b&&t.remove(b),r.set(p,v)}function u(p){let _=r.get(p);if(_){let m=p.index;m!==null&&_.version<m.version&&h(p)}else h(p);return r.get(p)}function f(){for(let p in s){let _=s[p].deref();_!==void 0&&l(_)}}return{get:c,update:d,getWireframeAttribute:u,dispose:f}}function QM(i,t,e){let n;function s(h){n=h}let r,o;function a(h){r=h.type,o=h.bytesPerElement}function l(h,u){i.drawElements(n,u,r,h*o),e.update(u,n,1)}function c(h,u,f){f!==0&&(i.drawElementsInstanced(n,u,r,h*o,f),e.update(u,n,f))}function d(h,u,f){if(f===0)return;t.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,u,0,r,h,0,f);let _=0;for(let m=0;m<f;m++)_+=u[m];e.update(_,n,1)}this.setMode=s,this.setIndex=a,this.render=l,this.renderInstances=c,this.renderMultiDraw=d}function tw(i){let t={geometries:0,textures:0},e={frame:0,calls:0,triangles:0,points:0,lines:0};function n(r,o,a){switch(e.calls++,o){case i.TRIANGLES:e.triangles+=a*(r/3);break;case i.LINES:e.lines+=a*(r/2);break;case i.LINE_STRIP:e.lines+=a*(r-1);break;case i.LINE_LOOP:e.lines+=a*r;break;case i.POINTS:e.points+=a*r;break;default:te("WebGLInfo: Unknown draw mode:",o);break}}function s(){e.calls=0,e.triangles=0,e.points=0,e.lines=0}return{memory:t,render:e,programs:null,autoReset:!0,reset:s,update:n}}function ew(i,t,e){let n=new WeakMap,s=new De;function r(o,a,l){let c=o.morphTargetInfluences,d=a.morphAttributes.position||a.morphAttributes.normal||a.morphAttributes.color,h=d!==void 0?d.length:0,u=n.get(a);if(u===void 0||u.count!==h){let O=function(){x.dispose(),n.delete(a),a.removeEventListener("dispose",O)};u!==void 0&&u.texture.dispose();let f=a.morphAttributes.position!==void 0,p=a.morphAttributes.normal!==void 0,_=a.morphAttributes.color!==void 0,m=a.morphAttributes.position||[],g=a.morphAttributes.normal||[],y=a.morphAttributes.color||[],T=0;f===!0&&(T=1),p===!0&&(T=2),_===!0&&(T=3);let v=a.attributes.position.count*T,M=1;v>t.maxTextureSize&&(M=Math.ceil(v/t.maxTextureSize),v=t.maxTextureSize);let b=new Float32Array(v*M*4*h),x=new Oa(b,v,M,h);x.type=Fi,x.needsUpdate=!0;let w=T*4;for(let P=0;P<h;P++){let L=m[P],B=g[P],G=y[P],D=v*M*4*P;for(let X=0;X<L.count;X++){let Z=X*w;f===!0&&(s.fromBufferAttribute(L,X),b[D+Z+0]=s.x,b[D+Z+1]=s.y,b[D+Z+2]=s.z,b[D+Z+3]=0),p===!0&&(s.fromBufferAttribute(B,X),b[D+Z+4]=s.x,b[D+Z+5]=s.y,b[D+Z+6]=s.z,b[D+Z+7]=0),_===!0&&(s.fromBufferAttribute(G,X),b[D+Z+8]=s.x,b[D+Z+9]=s.y,b[D+Z+10]=s.z,b[D+Z+11]=G.itemSize===4?s.w:1)}}u={count:h,texture:x,size:new Bt(v,M)},n.set(a,u),a.addEventListener("dispose",O)}if(o.isInstancedMesh===!0&&o.morphTexture!==null)l.getUniforms().setValue(i,"morphTexture",o.morphTexture,e);else{let f=0;for(let _=0;_<c.length;_++)f+=c[_];let p=a.morphTargetsRelative?1:1-f;l.getUniforms().setValue(i,"morphTargetBaseInfluence",p),l.getUniforms().setValue(i,"morphTargetInfluences",c)}l.getUniforms().setValue(i,"morphTargetsTexture",u.texture,e),l.getUniforms().setValue(i,"morphTargetsTextureSize",u.size)}return{update:r}}function nw(i,t,e,n,s){let r=new WeakMap;function o(c){let d=s.render.frame,h=c.geometry,u=t.get(c,h);if(r.get(u)!==d&&(t.update(u),r.set(u,d)),c.isInstancedMesh&&(c.hasEventListener("dispose",l)===!1&&c.addEventListener("dispose",l),r.get(c)!==d&&(e.update(c.instanceMatrix,i.ARRAY_BUFFER),c.instanceColor!==null&&e.update(c.instanceColor,i.ARRAY_BUFFER),r.set(c,d))),c.isSkinnedMesh){let f=c.skeleton;r.get(f)!==d&&(f.update(),r.set(f,d))}return u}function a(){r=new WeakMap}function l(c){let d=c.target;d.removeEventListener("dispose",l),n.releaseStatesOfObject(d),e.remove(d.instanceMatrix),d.instanceColor!==null&&e.remove(d.instanceColor)}return{update:o,dispose:a}}var iw={[Od]:"LINEAR_TONE_MAPPING",[Ud]:"REINHARD_TONE_MAPPING",[Fd]:"CINEON_TONE_MAPPING",[Bd]:"ACES_FILMIC_TONE_MAPPING",[zd]:"AGX_TONE_MAPPING",[Vd]:"NEUTRAL_TONE_MAPPING",[kd]:"CUSTOM_TONE_MAPPING"};function sw(i,t,e,n,s,r){let o=new Xn(t,e,{type:i,depthBuffer:s,stencilBuffer:r,samples:n?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),a=null,l=null,c=null,d=new pe;d.setAttribute("position",new ie([-1,3,0,-1,-1,0,3,-1,0],3)),d.setAttribute("uv",new ie([0,2,0,0,2,0],2));let h=new Dc({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),u=new St(d,h),f=new el(-1,1,1,-1,0,1),p=null,_=null,m=!1,g,y=null,T=[],v=!1;this.setSize=function(M,b){o.setSize(M,b),a!==null&&a.setSize(M,b),l!==null&&l.setSize(M,b);for(let x=0;x<T.length;x++){let w=T[x];w.setSize&&w.setSize(M,b)}},this.setEffects=function(M){T=M,v=T.length>0&&T[0].isRenderPass===!0;let b=o.width,x=o.height;T.length>0&&a===null&&(a=new Xn(b,x,{type:Ji,depthBuffer:!1,stencilBuffer:!1}),l=new Xn(b,x,{type:Ji,depthBuffer:!1,stencilBuffer:!1}));let w=s===!0&&T.some(O=>O.needsDepthTexture===!0);w!==(o.depthTexture!==null)&&(w===!0&&c===null&&(c=new Fs(b,x),r===!0&&(c.format=zs,c.type=Or)),o.dispose(),o.depthTexture=w?c:null,o.resolveDepthBuffer=w,o.storeMultisampledDepthBuffer=w);for(let O=0;O<T.length;O++){let P=T[O];P.setSize&&P.setSize(b,x),w&&P.needsDepthTexture===!0&&P.setDepthTexture&&P.setDepthTexture(c)}},this.begin=function(M,b){if(m||M.toneMapping===ds&&T.length===0)return!1;if(y=b,b!==null){let x=b.width,w=b.height;(o.width!==x||o.height!==w)&&this.setSize(x,w)}return v===!1&&M.setRenderTarget(o),g=M.toneMapping,M.toneMapping=ds,!0},this.hasRenderPass=function(){return v},this.end=function(M,b){M.toneMapping=g,m=!0;let x=o,w=a;for(let O=0;O<T.length;O++){let P=T[O];P.enabled!==!1&&(P.render(M,w,x,b),P.needsSwap!==!1&&(x=w,w=w===a?l:a))}if(p!==M.outputColorSpace||_!==M.toneMapping){p=M.outputColorSpace,_=M.toneMapping,h.defines={},Se.getTransfer(p)===Ie&&(h.defines.SRGB_TRANSFER="");let O=iw[_];O&&(h.defines[O]=""),h.needsUpdate=!0}h.uniforms.tDiffuse.value=x.texture,M.setRenderTarget(y),M.render(u,f),y=null,m=!1},this.isCompositing=function(){return m},this.dispose=function(){o.dispose(),a!==null&&a.dispose(),l!==null&&l.dispose(),d.dispose(),h.dispose()}}var Xg=new Wn,Yg=new Fs(1,1),qg=new Wa(1),$g=new Oa,Zg=new Cc,Jg=new Ga,bg=[],Tg=[],Eg=new Float32Array(16),Ag=new Float32Array(9),Cg=new Float32Array(4);function Yo(i,t,e){let n=i[0];if(n<=0||n>0)return i;let s=t*e,r=bg[s];if(r===void 0&&(r=new Float32Array(s),bg[s]=r),t!==0){n.toArray(r,0);for(let o=1,a=0;o!==t;++o)a+=e,i[o].toArray(r,a)}return r}function Rn(i,t){if(i.length!==t.length)return!1;for(let e=0,n=i.length;e<n;e++)if(i[e]!==t[e])return!1;return!0}function Pn(i,t){for(let e=0,n=t.length;e<n;e++)i[e]=t[e]}function kh(i,t){let e=Tg[t];e===void 0&&(e=new Int32Array(t),Tg[t]=e);for(let n=0;n!==t;++n)e[n]=i.allocateTextureUnit();return e}function rw(i,t){let e=this.cache;e[0]!==t&&(i.uniform1f(this.addr,t),e[0]=t)}function ow(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2f(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(Rn(e,t))return;i.uniform2fv(this.addr,t),Pn(e,t)}}function aw(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3f(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else if(t.r!==void 0)(e[0]!==t.r||e[1]!==t.g||e[2]!==t.b)&&(i.uniform3f(this.addr,t.r,t.g,t.b),e[0]=t.r,e[1]=t.g,e[2]=t.b);else{if(Rn(e,t))return;i.uniform3fv(this.addr,t),Pn(e,t)}}function lw(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4f(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(Rn(e,t))return;i.uniform4fv(this.addr,t),Pn(e,t)}}function cw(i,t){let e=this.cache,n=t.elements;if(n===void 0){if(Rn(e,t))return;i.uniformMatrix2fv(this.addr,!1,t),Pn(e,t)}else{if(Rn(e,n))return;Cg.set(n),i.uniformMatrix2fv(this.addr,!1,Cg),Pn(e,n)}}function hw(i,t){let e=this.cache,n=t.elements;if(n===void 0){if(Rn(e,t))return;i.uniformMatrix3fv(this.addr,!1,t),Pn(e,t)}else{if(Rn(e,n))return;Ag.set(n),i.uniformMatrix3fv(this.addr,!1,Ag),Pn(e,n)}}function uw(i,t){let e=this.cache,n=t.elements;if(n===void 0){if(Rn(e,t))return;i.uniformMatrix4fv(this.addr,!1,t),Pn(e,t)}else{if(Rn(e,n))return;Eg.set(n),i.uniformMatrix4fv(this.addr,!1,Eg),Pn(e,n)}}function dw(i,t){let e=this.cache;e[0]!==t&&(i.uniform1i(this.addr,t),e[0]=t)}function fw(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2i(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(Rn(e,t))return;i.uniform2iv(this.addr,t),Pn(e,t)}}function pw(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3i(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else{if(Rn(e,t))return;i.uniform3iv(this.addr,t),Pn(e,t)}}function mw(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4i(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(Rn(e,t))return;i.uniform4iv(this.addr,t),Pn(e,t)}}function gw(i,t){let e=this.cache;e[0]!==t&&(i.uniform1ui(this.addr,t),e[0]=t)}function _w(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2ui(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(Rn(e,t))return;i.uniform2uiv(this.addr,t),Pn(e,t)}}function xw(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3ui(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else{if(Rn(e,t))return;i.uniform3uiv(this.addr,t),Pn(e,t)}}function yw(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4ui(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(Rn(e,t))return;i.uniform4uiv(this.addr,t),Pn(e,t)}}function zh(i){return i.version===0&&(i.compareFunction=jd,i.needsUpdate=!0),i}function vw(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_2D_SHADOW?r=zh(Yg):r=Xg,e.setTexture2D(t||r,s)}function Sw(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),e.setTexture3D(t||Zg,s)}function Mw(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_CUBE_SHADOW?r=zh(qg):r=Jg,e.setTextureCube(t||r,s)}function ww(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),e.setTexture2DArray(t||$g,s)}function bw(i){switch(i){case 5126:return rw;case 35664:return ow;case 35665:return aw;case 35666:return lw;case 35674:return cw;case 35675:return hw;case 35676:return uw;case 5124:case 35670:return dw;case 35667:case 35671:return fw;case 35668:case 35672:return pw;case 35669:case 35673:return mw;case 5125:return gw;case 36294:return _w;case 36295:return xw;case 36296:return yw;case 35678:case 36198:case 36298:case 36306:case 35682:return vw;case 35679:case 36299:case 36307:return Sw;case 35680:case 36300:case 36308:case 36293:return Mw;case 36289:case 36303:case 36311:case 36292:return ww}}function Tw(i,t){i.uniform1fv(this.addr,t)}function Ew(i,t){let e=Yo(t,this.size,2);i.uniform2fv(this.addr,e)}function Aw(i,t){let e=Yo(t,this.size,3);i.uniform3fv(this.addr,e)}function Cw(i,t){let e=Yo(t,this.size,4);i.uniform4fv(this.addr,e)}function Rw(i,t){let e=Yo(t,this.size,4);i.uniformMatrix2fv(this.addr,!1,e)}function Pw(i,t){let e=Yo(t,this.size,9);i.uniformMatrix3fv(this.addr,!1,e)}function Iw(i,t){let e=Yo(t,this.size,16);i.uniformMatrix4fv(this.addr,!1,e)}function Lw(i,t){i.uniform1iv(this.addr,t)}function Dw(i,t){i.uniform2iv(this.addr,t)}function Nw(i,t){i.uniform3iv(this.addr,t)}function Ow(i,t){i.uniform4iv(this.addr,t)}function Uw(i,t){i.uniform1uiv(this.addr,t)}function Fw(i,t){i.uniform2uiv(this.addr,t)}function Bw(i,t){i.uniform3uiv(this.addr,t)}function kw(i,t){i.uniform4uiv(this.addr,t)}function zw(i,t,e){let n=this.cache,s=t.length,r=kh(e,s);Rn(n,r)||(i.uniform1iv(this.addr,r),Pn(n,r));let o;this.type===i.SAMPLER_2D_SHADOW?o=zh(Yg):o=Xg;for(let a=0;a!==s;++a)e.setTexture2D(t[a]||o,r[a])}function Vw(i,t,e){let n=this.cache,s=t.length,r=kh(e,s);Rn(n,r)||(i.uniform1iv(this.addr,r),Pn(n,r));for(let o=0;o!==s;++o)e.setTexture3D(t[o]||Zg,r[o])}function Gw(i,t,e){let n=this.cache,s=t.length,r=kh(e,s);Rn(n,r)||(i.uniform1iv(this.addr,r),Pn(n,r));let o;this.type===i.SAMPLER_CUBE_SHADOW?o=zh(qg):o=Jg;for(let a=0;a!==s;++a)e.setTextureCube(t[a]||o,r[a])}function Hw(i,t,e){let n=this.cache,s=t.length,r=kh(e,s);Rn(n,r)||(i.uniform1iv(this.addr,r),Pn(n,r));for(let o=0;o!==s;++o)e.setTexture2DArray(t[o]||$g,r[o])}function Ww(i){switch(i){case 5126:return Tw;case 35664:return Ew;case 35665:return Aw;case 35666:return Cw;case 35674:return Rw;case 35675:return Pw;case 35676:return Iw;case 5124:case 35670:return Lw;case 35667:case 35671:return Dw;case 35668:case 35672:return Nw;case 35669:case 35673:return Ow;case 5125:return Uw;case 36294:return Fw;case 36295:return Bw;case 36296:return kw;case 35678:case 36198:case 36298:case 36306:case 35682:return zw;case 35679:case 36299:case 36307:return Vw;case 35680:case 36300:case 36308:case 36293:return Gw;case 36289:case 36303:case 36311:case 36292:return Hw}}var uf=class{constructor(t,e,n){this.id=t,this.addr=n,this.cache=[],this.type=e.type,this.setValue=bw(e.type)}},df=class{constructor(t,e,n){this.id=t,this.addr=n,this.cache=[],this.type=e.type,this.size=e.size,this.setValue=Ww(e.type)}},ff=class{constructor(t){this.id=t,this.seq=[],this.map={}}setValue(t,e,n){let s=this.seq;for(let r=0,o=s.length;r!==o;++r){let a=s[r];a.setValue(t,e[a.id],n)}}},cf=/(\w+)(\])?(\[|\.)?/g;function Rg(i,t){i.seq.push(t),i.map[t.id]=t}function Xw(i,t,e){let n=i.name,s=n.length;for(cf.lastIndex=0;;){let r=cf.exec(n),o=cf.lastIndex,a=r[1],l=r[2]==="]",c=r[3];if(l&&(a=a|0),c===void 0||c==="["&&o+2===s){Rg(e,c===void 0?new uf(a,i,t):new df(a,i,t));break}else{let h=e.map[a];h===void 0&&(h=new ff(a),Rg(e,h)),e=h}}}var Xo=class{constructor(t,e){this.seq=[],this.map={};let n=t.getProgramParameter(e,t.ACTIVE_UNIFORMS);for(let o=0;o<n;++o){let a=t.getActiveUniform(e,o),l=t.getUniformLocation(e,a.name);Xw(a,l,this)}let s=[],r=[];for(let o of this.seq)o.type===t.SAMPLER_2D_SHADOW||o.type===t.SAMPLER_CUBE_SHADOW||o.type===t.SAMPLER_2D_ARRAY_SHADOW?s.push(o):r.push(o);s.length>0&&(this.seq=s.concat(r))}setValue(t,e,n,s){let r=this.map[e];r!==void 0&&r.setValue(t,n,s)}setOptional(t,e,n){let s=e[n];s!==void 0&&this.setValue(t,n,s)}static upload(t,e,n,s){for(let r=0,o=e.length;r!==o;++r){let a=e[r],l=n[a.id];l.needsUpdate!==!1&&a.setValue(t,l.value,s)}}static seqWithValue(t,e){let n=[];for(let s=0,r=t.length;s!==r;++s){let o=t[s];o.id in e&&n.push(o)}return n}};function Pg(i,t,e){let n=i.createShader(t);return i.shaderSource(n,e),i.compileShader(n),n}var Yw=37297,qw=0;function $w(i,t){let e=i.split(`
`),n=[],s=Math.max(t-6,0),r=Math.min(t+6,e.length);for(let o=s;o<r;o++){let a=o+1;n.push(`${a===t?">":" "} ${a}: ${e[o]}`)}return n.join(`
`)}var Ig=new re;function Zw(i){Se._getMatrix(Ig,Se.workingColorSpace,i);let t=`mat3( ${Ig.elements.map(e=>e.toFixed(4))} )`;switch(Se.getTransfer(i)){case La:return[t,"LinearTransferOETF"];case Ie:return[t,"sRGBTransferOETF"];default:return jt("WebGLProgram: Unsupported color space: ",i),[t,"LinearTransferOETF"]}}function Lg(i,t,e){let n=i.getShaderParameter(t,i.COMPILE_STATUS),r=(i.getShaderInfoLog(t)||"").trim();if(n&&r==="")return"";let o=/ERROR: 0:(\d+)/.exec(r);if(o){let a=parseInt(o[1]);return e.toUpperCase()+`

`+r+`

`+$w(i.getShaderSource(t),a)}else return r}function Jw(i,t){let e=Zw(t);return[`vec4 ${i}( vec4 value ) {`,`	return ${e[1]}( vec4( ${e[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var jw={[Od]:"Linear",[Ud]:"Reinhard",[Fd]:"Cineon",[Bd]:"ACESFilmic",[zd]:"AgX",[Vd]:"Neutral",[kd]:"Custom"};function Kw(i,t){let e=jw[t];return e===void 0?(jt("WebGLProgram: Unsupported toneMapping:",t),"vec3 "+i+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+i+"( vec3 color ) { return "+e+"ToneMapping( color ); }"}var Uh=new R;function Qw(){Se.getLuminanceCoefficients(Uh);let i=Uh.x.toFixed(4),t=Uh.y.toFixed(4),e=Uh.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${t}, ${e} );`,"	return dot( weights, rgb );","}"].join(`
`)}function tb(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(_l).join(`
`)}function eb(i){let t=[];for(let e in i){let n=i[e];n!==!1&&t.push("#define "+e+" "+n)}return t.join(`
`)}function nb(i,t){let e={},n=i.getProgramParameter(t,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){let r=i.getActiveAttrib(t,s),o=r.name,a=1;r.type===i.FLOAT_MAT2&&(a=2),r.type===i.FLOAT_MAT3&&(a=3),r.type===i.FLOAT_MAT4&&(a=4),e[o]={type:r.type,location:i.getAttribLocation(t,o),locationSize:a}}return e}function _l(i){return i!==""}function Dg(i,t){let e=t.numSpotLightShadows+t.numSpotLightMaps-t.numSpotLightShadowsWithMaps;return i.replace(/NUM_SUN_LIGHTS/g,t.numSunLights).replace(/NUM_DIR_LIGHTS/g,t.numDirLights).replace(/NUM_SPOT_LIGHTS/g,t.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,t.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,e).replace(/NUM_RECT_AREA_LIGHTS/g,t.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,t.numPointLights).replace(/NUM_HEMI_LIGHTS/g,t.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,t.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,t.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,t.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,t.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,t.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,t.numLightProbeGrids)}function Ng(i,t){return i.replace(/NUM_CLIPPING_PLANES/g,t.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,t.numClippingPlanes-t.numClipIntersection)}var ib=/^[ \t]*#include +<([\w\d./]+)>/gm;function pf(i){return i.replace(ib,sb)}function sb(i,t){let e=me[t];if(e===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+t+">");return pf(e)}var rb=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function Og(i){return i.replace(rb,ob)}function ob(i,t,e,n){let s="";for(let r=parseInt(t);r<parseInt(e);r++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function Ug(i){let t=`precision ${i.precision} float;
	precision ${i.precision} int;
	precision ${i.precision} sampler2D;
	precision ${i.precision} samplerCube;
	precision ${i.precision} sampler3D;
	precision ${i.precision} sampler2DArray;
	precision ${i.precision} sampler2DShadow;
	precision ${i.precision} samplerCubeShadow;
	precision ${i.precision} sampler2DArrayShadow;
	precision ${i.precision} isampler2D;
	precision ${i.precision} isampler3D;
	precision ${i.precision} isamplerCube;
	precision ${i.precision} isampler2DArray;
	precision ${i.precision} usampler2D;
	precision ${i.precision} usampler3D;
	precision ${i.precision} usamplerCube;
	precision ${i.precision} usampler2DArray;
	`;return i.precision==="highp"?t+=`
#define HIGH_PRECISION`:i.precision==="mediump"?t+=`
#define MEDIUM_PRECISION`:i.precision==="lowp"&&(t+=`
#define LOW_PRECISION`),t}var ab={[Ir]:"SHADOWMAP_TYPE_PCF",[Vo]:"SHADOWMAP_TYPE_VSM"};function lb(i){return ab[i.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var cb={[Ho]:"ENVMAP_MODE_REFRACTION"};function hb(i){return i.envMap===!1?"ENVMAP_MODE_REFLECTION":cb[i.envMapMode]||"ENVMAP_MODE_REFLECTION"}var ub={[qc]:"ENVMAP_BLENDING_MULTIPLY",[eg]:"ENVMAP_BLENDING_MIX",[ng]:"ENVMAP_BLENDING_ADD"};function db(i){return i.envMap===!1?"ENVMAP_BLENDING_NONE":ub[i.combine]||"ENVMAP_BLENDING_NONE"}function fb(i,t,e,n){let s=i.getContext(),r=e.defines,o=e.vertexShader,a=e.fragmentShader,l=lb(e),c=e.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",d=hb(e),h=db(e),u=tb(e),f=eb(r),p=s.createProgram(),_,m,g=e.glslVersion?"#version "+e.glslVersion+`
`:"";e.isRawShaderMaterial?(_=["#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,f].filter(_l).join(`
`),_.length>0&&(_+=`
`),m=["#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,f].filter(_l).join(`
`),m.length>0&&(m+=`
`)):(_=[Ug(e),"#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,f,e.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",e.batching?"#define USE_BATCHING":"",e.batchingColor?"#define USE_BATCHING_COLOR":"",e.instancing?"#define USE_INSTANCING":"",e.instancingColor?"#define USE_INSTANCING_COLOR":"",e.instancingMorph?"#define USE_INSTANCING_MORPH":"",e.useFog&&e.fog?"#define USE_FOG":"",e.useFog&&e.fogExp2?"#define FOG_EXP2":"",e.map?"#define USE_MAP":"",e.envMap?"#define USE_ENVMAP":"",e.envMap?"#define "+d:"",e.lightMap?"#define USE_LIGHTMAP":"",e.aoMap?"#define USE_AOMAP":"",e.bumpMap?"#define USE_BUMPMAP":"",e.normalMap?"#define USE_NORMALMAP":"",e.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",e.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",e.displacementMap?"#define USE_DISPLACEMENTMAP":"",e.emissiveMap?"#define USE_EMISSIVEMAP":"",e.anisotropy?"#define USE_ANISOTROPY":"",e.anisotropyMap?"#define USE_ANISOTROPYMAP":"",e.clearcoatMap?"#define USE_CLEARCOATMAP":"",e.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",e.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",e.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",e.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",e.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",e.specularMap?"#define USE_SPECULARMAP":"",e.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",e.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",e.roughnessMap?"#define USE_ROUGHNESSMAP":"",e.metalnessMap?"#define USE_METALNESSMAP":"",e.alphaMap?"#define USE_ALPHAMAP":"",e.alphaHash?"#define USE_ALPHAHASH":"",e.transmission?"#define USE_TRANSMISSION":"",e.transmissionMap?"#define USE_TRANSMISSIONMAP":"",e.thicknessMap?"#define USE_THICKNESSMAP":"",e.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",e.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",e.mapUv?"#define MAP_UV "+e.mapUv:"",e.alphaMapUv?"#define ALPHAMAP_UV "+e.alphaMapUv:"",e.lightMapUv?"#define LIGHTMAP_UV "+e.lightMapUv:"",e.aoMapUv?"#define AOMAP_UV "+e.aoMapUv:"",e.emissiveMapUv?"#define EMISSIVEMAP_UV "+e.emissiveMapUv:"",e.bumpMapUv?"#define BUMPMAP_UV "+e.bumpMapUv:"",e.normalMapUv?"#define NORMALMAP_UV "+e.normalMapUv:"",e.displacementMapUv?"#define DISPLACEMENTMAP_UV "+e.displacementMapUv:"",e.metalnessMapUv?"#define METALNESSMAP_UV "+e.metalnessMapUv:"",e.roughnessMapUv?"#define ROUGHNESSMAP_UV "+e.roughnessMapUv:"",e.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+e.anisotropyMapUv:"",e.clearcoatMapUv?"#define CLEARCOATMAP_UV "+e.clearcoatMapUv:"",e.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+e.clearcoatNormalMapUv:"",e.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+e.clearcoatRoughnessMapUv:"",e.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+e.diffuseRoughnessMapUv:"",e.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+e.iridescenceMapUv:"",e.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+e.iridescenceThicknessMapUv:"",e.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+e.sheenColorMapUv:"",e.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+e.sheenRoughnessMapUv:"",e.specularMapUv?"#define SPECULARMAP_UV "+e.specularMapUv:"",e.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+e.specularColorMapUv:"",e.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+e.specularIntensityMapUv:"",e.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+e.transmissionMapUv:"",e.thicknessMapUv?"#define THICKNESSMAP_UV "+e.thicknessMapUv:"",e.vertexTangents&&e.flatShading===!1?"#define USE_TANGENT":"",e.vertexNormals?"#define HAS_NORMAL":"",e.vertexColors?"#define USE_COLOR":"",e.vertexAlphas?"#define USE_COLOR_ALPHA":"",e.vertexUv1s?"#define USE_UV1":"",e.vertexUv2s?"#define USE_UV2":"",e.vertexUv3s?"#define USE_UV3":"",e.pointsUvs?"#define USE_POINTS_UV":"",e.flatShading?"#define FLAT_SHADED":"",e.skinning?"#define USE_SKINNING":"",e.morphTargets?"#define USE_MORPHTARGETS":"",e.morphNormals&&e.flatShading===!1?"#define USE_MORPHNORMALS":"",e.morphColors?"#define USE_MORPHCOLORS":"",e.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+e.morphTextureStride:"",e.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+e.morphTargetsCount:"",e.doubleSided?"#define DOUBLE_SIDED":"",e.flipSided?"#define FLIP_SIDED":"",e.shadowMapEnabled?"#define USE_SHADOWMAP":"",e.shadowMapEnabled?"#define "+l:"",e.sizeAttenuation?"#define USE_SIZEATTENUATION":"",e.numLightProbes>0?"#define USE_LIGHT_PROBES":"",e.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",e.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(_l).join(`
`),m=[Ug(e),"#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,f,e.useFog&&e.fog?"#define USE_FOG":"",e.useFog&&e.fogExp2?"#define FOG_EXP2":"",e.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",e.map?"#define USE_MAP":"",e.matcap?"#define USE_MATCAP":"",e.envMap?"#define USE_ENVMAP":"",e.envMap?"#define "+c:"",e.envMap?"#define "+d:"",e.envMap?"#define "+h:"",e.envMapPMREM?"#define ENVMAP_MAX_LOD "+e.envMapMaxLod+".0":"",e.envMapPMREM?"#define ENVMAP_SIZE "+e.envMapSize+".0":"",e.lightMap?"#define USE_LIGHTMAP":"",e.aoMap?"#define USE_AOMAP":"",e.bumpMap?"#define USE_BUMPMAP":"",e.normalMap?"#define USE_NORMALMAP":"",e.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",e.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",e.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",e.emissiveMap?"#define USE_EMISSIVEMAP":"",e.anisotropy?"#define USE_ANISOTROPY":"",e.anisotropyMap?"#define USE_ANISOTROPYMAP":"",e.clearcoat?"#define USE_CLEARCOAT":"",e.clearcoatMap?"#define USE_CLEARCOATMAP":"",e.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",e.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",e.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",e.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",e.dispersion?"#define USE_DISPERSION":"",e.retroreflection?"#define USE_RETROREFLECTION":"",e.iridescence?"#define USE_IRIDESCENCE":"",e.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",e.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",e.specularMap?"#define USE_SPECULARMAP":"",e.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",e.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",e.roughnessMap?"#define USE_ROUGHNESSMAP":"",e.metalnessMap?"#define USE_METALNESSMAP":"",e.alphaMap?"#define USE_ALPHAMAP":"",e.alphaTest?"#define USE_ALPHATEST":"",e.alphaHash?"#define USE_ALPHAHASH":"",e.sheen?"#define USE_SHEEN":"",e.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",e.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",e.transmission?"#define USE_TRANSMISSION":"",e.transmissionMap?"#define USE_TRANSMISSIONMAP":"",e.thicknessMap?"#define USE_THICKNESSMAP":"",e.vertexTangents&&e.flatShading===!1?"#define USE_TANGENT":"",e.vertexColors||e.instancingColor?"#define USE_COLOR":"",e.vertexAlphas||e.batchingColor?"#define USE_COLOR_ALPHA":"",e.vertexUv1s?"#define USE_UV1":"",e.vertexUv2s?"#define USE_UV2":"",e.vertexUv3s?"#define USE_UV3":"",e.pointsUvs?"#define USE_POINTS_UV":"",e.gradientMap?"#define USE_GRADIENTMAP":"",e.flatShading?"#define FLAT_SHADED":"",e.doubleSided?"#define DOUBLE_SIDED":"",e.flipSided?"#define FLIP_SIDED":"",e.shadowMapEnabled?"#define USE_SHADOWMAP":"",e.shadowMapEnabled?"#define "+l:"",e.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",e.numLightProbes>0?"#define USE_LIGHT_PROBES":"",e.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",e.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",e.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",e.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",e.toneMapping!==ds?"#define TONE_MAPPING":"",e.toneMapping!==ds?me.tonemapping_pars_fragment:"",e.toneMapping!==ds?Kw("toneMapping",e.toneMapping):"",e.dithering?"#define DITHERING":"",e.opaque?"#define OPAQUE":"",me.colorspace_pars_fragment,Jw("linearToOutputTexel",e.outputColorSpace),Qw(),e.useDepthPacking?"#define DEPTH_PACKING "+e.depthPacking:"",`
`].filter(_l).join(`
`)),o=pf(o),o=Dg(o,e),o=Ng(o,e),a=pf(a),a=Dg(a,e),a=Ng(a,e),o=Og(o),a=Og(a),e.isRawShaderMaterial!==!0&&(g=`#version 300 es
`,_=[u,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+_,m=["#define varying in",e.glslVersion===Qd?"":"layout(location = 0) out highp vec4 pc_fragColor;",e.glslVersion===Qd?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+m);let y=g+_+o,T=g+m+a,v=Pg(s,s.VERTEX_SHADER,y),M=Pg(s,s.FRAGMENT_SHADER,T);s.attachShader(p,v),s.attachShader(p,M),e.index0AttributeName!==void 0?s.bindAttribLocation(p,0,e.index0AttributeName):e.hasPositionAttribute===!0&&s.bindAttribLocation(p,0,"position"),s.linkProgram(p);function b(P){if(i.debug.checkShaderErrors){let L=s.getProgramInfoLog(p)||"",B=s.getShaderInfoLog(v)||"",G=s.getShaderInfoLog(M)||"",D=L.trim(),X=B.trim(),Z=G.trim(),W=!0,at=!0;if(s.getProgramParameter(p,s.LINK_STATUS)===!1)if(W=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,p,v,M);else{let k=Lg(s,v,"vertex"),q=Lg(s,M,"fragment");te("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(p,s.VALIDATE_STATUS)+`

Material Name: `+P.name+`
Material Type: `+P.type+`

Program Info Log: `+D+`
`+k+`
`+q)}else D!==""?jt("WebGLProgram: Program Info Log:",D):(X===""||Z==="")&&(at=!1);at&&(P.diagnostics={runnable:W,programLog:D,vertexShader:{log:X,prefix:_},fragmentShader:{log:Z,prefix:m}})}s.deleteShader(v),s.deleteShader(M),x=new Xo(s,p),w=nb(s,p)}let x;this.getUniforms=function(){return x===void 0&&b(this),x};let w;this.getAttributes=function(){return w===void 0&&b(this),w};let O=e.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return O===!1&&(O=s.getProgramParameter(p,Yw)),O},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(p),this.program=void 0},this.type=e.shaderType,this.name=e.shaderName,this.id=qw++,this.cacheKey=t,this.usedTimes=1,this.program=p,this.vertexShader=v,this.fragmentShader=M,this}var pb=0,mf=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(t,e,n){let s=this._getShaderCacheForMaterial(t);return s.has(e)===!1&&(s.add(e),e.usedTimes++),s.has(n)===!1&&(s.add(n),n.usedTimes++),this}remove(t){let e=this.materialCache.get(t);for(let n of e)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(t),this}getVertexShaderStage(t){return this._getShaderStage(t.vertexShader)}getFragmentShaderStage(t){return this._getShaderStage(t.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(t){let e=this.materialCache,n=e.get(t);return n===void 0&&(n=new Set,e.set(t,n)),n}_getShaderStage(t){let e=this.shaderCache,n=e.get(t);return n===void 0&&(n=new gf(t),e.set(t,n)),n}},gf=class{constructor(t){this.id=pb++,this.code=t,this.usedTimes=0}};function mb(i){return i===fr||i===ul||i===dl}function gb(i,t,e,n,s,r){let o=new Lo,a=new mf,l=new Set,c=[],d=new Map,h=n.logarithmicDepthBuffer,u={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function f(x){return l.add(x),x===0?"uv":`uv${x}`}function p(x,w,O,P,L,B){let G=P.fog,D=L.geometry,X=x.isMeshStandardMaterial||x.isMeshLambertMaterial||x.isMeshPhongMaterial?P.environment:null,Z=x.isMeshStandardMaterial||x.isMeshLambertMaterial&&!x.envMap||x.isMeshPhongMaterial&&!x.envMap,W=t.get(x.envMap||X,Z),at=u[x.type],k=n.precision;x.precision!==null&&(k=n.getMaxPrecision(x.precision),k!==x.precision&&jt("WebGLProgram.getParameters:",x.precision,"not supported, using",k,"instead."));let q=D.morphAttributes.position||D.morphAttributes.normal||D.morphAttributes.color,Q=q!==void 0?q.length:0,lt=0;D.morphAttributes.position!==void 0&&(lt=1),D.morphAttributes.normal!==void 0&&(lt=2),D.morphAttributes.color!==void 0&&(lt=3);let ht,et,mt,xt;if(at){let Rt=fi[at];ht=Rt.vertexShader,et=Rt.fragmentShader}else{ht=x.vertexShader,et=x.fragmentShader;let Rt=a.getVertexShaderStage(x),ue=a.getFragmentShaderStage(x);a.update(x,Rt,ue),mt=Rt.id,xt=ue.id}let Ct=i.getRenderTarget(),wt=i.state.buffers.depth.getReversed(),$t=L.isInstancedMesh===!0,le=L.isBatchedMesh===!0,Yt=!!x.map,ge=!!x.matcap,de=!!W,oe=de&&W.isPMREMTexture===!0,Qe=!!x.aoMap,Xe=!!x.lightMap,mn=!!x.bumpMap&&x.wireframe===!1,Be=!!x.normalMap,Nn=!!x.displacementMap,we=!!x.emissiveMap,bn=!!x.metalnessMap,an=!!x.roughnessMap,gn=x.anisotropy>0,V=x.clearcoat>0,Pt=x.diffuseRoughness>0,Kt=x.dispersion>0,ce=x.retroreflectivity>0,bt=x.iridescence>0,Ve=x.sheen>0,Ht=x.transmission>0,Jt=gn&&!!x.anisotropyMap,I=V&&!!x.clearcoatMap,E=V&&!!x.clearcoatNormalMap,$=V&&!!x.clearcoatRoughnessMap,dt=Pt&&!!x.diffuseRoughnessMap,ot=bt&&!!x.iridescenceMap,_t=bt&&!!x.iridescenceThicknessMap,yt=Ve&&!!x.sheenColorMap,nt=Ve&&!!x.sheenRoughnessMap,st=!!x.specularMap,pt=!!x.specularColorMap,z=!!x.specularIntensityMap,rt=Ht&&!!x.transmissionMap,it=Ht&&!!x.thicknessMap,Tt=!!x.gradientMap,gt=!!x.alphaMap,Mt=x.alphaTest>0,qt=!!x.alphaHash,ee=!!x.extensions,ut=ds;x.toneMapped&&(Ct===null||Ct.isXRRenderTarget===!0)&&(ut=i.toneMapping);let zt=oe?W.isCompressedCubeTexture?W.image[0].mipmaps:W.mipmaps:null,ne={shaderID:at,shaderType:x.type,shaderName:x.name,vertexShader:ht,fragmentShader:et,defines:x.defines,customVertexShaderID:mt,customFragmentShaderID:xt,isRawShaderMaterial:x.isRawShaderMaterial===!0,glslVersion:x.glslVersion,precision:k,batching:le,batchingColor:le&&L._colorsTexture!==null,instancing:$t,instancingColor:$t&&L.instanceColor!==null,instancingMorph:$t&&L.morphTexture!==null,outputColorSpace:Ct===null?i.outputColorSpace:Ct.isXRRenderTarget===!0?Ct.texture.colorSpace:Se.workingColorSpace,alphaToCoverage:!!x.alphaToCoverage,map:Yt,matcap:ge,envMap:de,envMapMode:de&&W.mapping,envMapPMREM:oe,envMapMaxLod:oe?zt.length-1:null,envMapSize:oe?zt[0].width:null,aoMap:Qe,lightMap:Xe,bumpMap:mn,normalMap:Be,displacementMap:Nn,emissiveMap:we,normalMapObjectSpace:Be&&x.normalMapType===rg,normalMapTangentSpace:Be&&x.normalMapType===fl,packedNormalMap:Be&&x.normalMapType===fl&&mb(x.normalMap.format),metalnessMap:bn,roughnessMap:an,anisotropy:gn,anisotropyMap:Jt,clearcoat:V,clearcoatMap:I,clearcoatNormalMap:E,clearcoatRoughnessMap:$,diffuseRoughness:Pt,diffuseRoughnessMap:dt,dispersion:Kt,retroreflection:ce,iridescence:bt,iridescenceMap:ot,iridescenceThicknessMap:_t,sheen:Ve,sheenColorMap:yt,sheenRoughnessMap:nt,specularMap:st,specularColorMap:pt,specularIntensityMap:z,transmission:Ht,transmissionMap:rt,thicknessMap:it,gradientMap:Tt,opaque:x.transparent===!1&&x.blending===Go&&x.alphaToCoverage===!1,alphaMap:gt,alphaTest:Mt,alphaHash:qt,combine:x.combine,mapUv:Yt&&f(x.map.channel),aoMapUv:Qe&&f(x.aoMap.channel),lightMapUv:Xe&&f(x.lightMap.channel),bumpMapUv:mn&&f(x.bumpMap.channel),normalMapUv:Be&&f(x.normalMap.channel),displacementMapUv:Nn&&f(x.displacementMap.channel),emissiveMapUv:we&&f(x.emissiveMap.channel),metalnessMapUv:bn&&f(x.metalnessMap.channel),roughnessMapUv:an&&f(x.roughnessMap.channel),anisotropyMapUv:Jt&&f(x.anisotropyMap.channel),clearcoatMapUv:I&&f(x.clearcoatMap.channel),clearcoatNormalMapUv:E&&f(x.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:$&&f(x.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:dt&&f(x.diffuseRoughnessMap.channel),iridescenceMapUv:ot&&f(x.iridescenceMap.channel),iridescenceThicknessMapUv:_t&&f(x.iridescenceThicknessMap.channel),sheenColorMapUv:yt&&f(x.sheenColorMap.channel),sheenRoughnessMapUv:nt&&f(x.sheenRoughnessMap.channel),specularMapUv:st&&f(x.specularMap.channel),specularColorMapUv:pt&&f(x.specularColorMap.channel),specularIntensityMapUv:z&&f(x.specularIntensityMap.channel),transmissionMapUv:rt&&f(x.transmissionMap.channel),thicknessMapUv:it&&f(x.thicknessMap.channel),alphaMapUv:gt&&f(x.alphaMap.channel),vertexTangents:!!D.attributes.tangent&&(Be||gn),vertexNormals:!!D.attributes.normal,vertexColors:x.vertexColors,vertexAlphas:x.vertexColors===!0&&!!D.attributes.color&&D.attributes.color.itemSize===4,pointsUvs:L.isPoints===!0&&!!D.attributes.uv&&(Yt||gt),fog:!!G,useFog:x.fog===!0,fogExp2:!!G&&G.isFogExp2,flatShading:x.wireframe===!1&&(x.flatShading===!0||D.attributes.normal===void 0&&Be===!1&&(x.isMeshLambertMaterial||x.isMeshPhongMaterial||x.isMeshStandardMaterial||x.isMeshPhysicalMaterial)),sizeAttenuation:x.sizeAttenuation===!0,logarithmicDepthBuffer:h,reversedDepthBuffer:wt,skinning:L.isSkinnedMesh===!0,hasPositionAttribute:D.attributes.position!==void 0,morphTargets:D.morphAttributes.position!==void 0,morphNormals:D.morphAttributes.normal!==void 0,morphColors:D.morphAttributes.color!==void 0,morphTargetsCount:Q,morphTextureStride:lt,numSunLights:w.sun.length,numDirLights:w.directional.length,numPointLights:w.point.length,numSpotLights:w.spot.length,numSpotLightMaps:w.spotLightMap.length,numRectAreaLights:w.rectArea.length,numHemiLights:w.hemi.length,numSunLightShadows:w.sunShadowMap.length,numDirLightShadows:w.directionalShadowMap.length,numPointLightShadows:w.pointShadowMap.length,numSpotLightShadows:w.spotShadowMap.length,numSpotLightShadowsWithMaps:w.numSpotLightShadowsWithMaps,numLightProbes:w.numLightProbes,numLightProbeGrids:B.filter(Rt=>Rt.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:x.dithering,shadowMapEnabled:i.shadowMap.enabled&&O.length>0,shadowMapType:i.shadowMap.type,toneMapping:ut,decodeVideoTexture:Yt&&x.map.isVideoTexture===!0&&Se.getTransfer(x.map.colorSpace)===Ie,decodeVideoTextureEmissive:we&&x.emissiveMap.isVideoTexture===!0&&Se.getTransfer(x.emissiveMap.colorSpace)===Ie,premultipliedAlpha:x.premultipliedAlpha,doubleSided:x.side===Mn,flipSided:x.side===Yn,useDepthPacking:x.depthPacking>=0,depthPacking:x.depthPacking||0,index0AttributeName:x.index0AttributeName,extensionClipCullDistance:ee&&x.extensions.clipCullDistance===!0&&e.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(ee&&x.extensions.multiDraw===!0||le)&&e.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:e.has("KHR_parallel_shader_compile"),customProgramCacheKey:x.customProgramCacheKey()};return ne.vertexUv1s=l.has(1),ne.vertexUv2s=l.has(2),ne.vertexUv3s=l.has(3),l.clear(),ne}function _(x){let w=[];if(x.shaderID?w.push(x.shaderID):(w.push(x.customVertexShaderID),w.push(x.customFragmentShaderID)),x.defines!==void 0)for(let O in x.defines)w.push(O),w.push(x.defines[O]);return x.isRawShaderMaterial===!1&&(m(w,x),g(w,x),w.push(i.outputColorSpace)),w.push(x.customProgramCacheKey),w.join()}function m(x,w){x.push(w.precision),x.push(w.outputColorSpace),x.push(w.envMapMode),x.push(w.envMapPMREM),x.push(w.envMapMaxLod),x.push(w.envMapSize),x.push(w.mapUv),x.push(w.alphaMapUv),x.push(w.lightMapUv),x.push(w.aoMapUv),x.push(w.bumpMapUv),x.push(w.normalMapUv),x.push(w.displacementMapUv),x.push(w.emissiveMapUv),x.push(w.metalnessMapUv),x.push(w.roughnessMapUv),x.push(w.anisotropyMapUv),x.push(w.clearcoatMapUv),x.push(w.clearcoatNormalMapUv),x.push(w.clearcoatRoughnessMapUv),x.push(w.diffuseRoughnessMapUv),x.push(w.iridescenceMapUv),x.push(w.iridescenceThicknessMapUv),x.push(w.sheenColorMapUv),x.push(w.sheenRoughnessMapUv),x.push(w.specularMapUv),x.push(w.specularColorMapUv),x.push(w.specularIntensityMapUv),x.push(w.transmissionMapUv),x.push(w.thicknessMapUv),x.push(w.combine),x.push(w.fogExp2),x.push(w.sizeAttenuation),x.push(w.morphTargetsCount),x.push(w.numSunLights),x.push(w.numDirLights),x.push(w.numPointLights),x.push(w.numSpotLights),x.push(w.numSpotLightMaps),x.push(w.numHemiLights),x.push(w.numRectAreaLights),x.push(w.numSunLightShadows),x.push(w.numDirLightShadows),x.push(w.numPointLightShadows),x.push(w.numSpotLightShadows),x.push(w.numSpotLightShadowsWithMaps),x.push(w.numLightProbes),x.push(w.numLightProbeGrids),x.push(w.shadowMapType),x.push(w.toneMapping),x.push(w.numClippingPlanes),x.push(w.numClipIntersection),x.push(w.depthPacking)}function g(x,w){o.disableAll(),w.instancing&&o.enable(0),w.instancingColor&&o.enable(1),w.instancingMorph&&o.enable(2),w.matcap&&o.enable(3),w.envMap&&o.enable(4),w.normalMapObjectSpace&&o.enable(5),w.normalMapTangentSpace&&o.enable(6),w.clearcoat&&o.enable(7),w.iridescence&&o.enable(8),w.alphaTest&&o.enable(9),w.vertexColors&&o.enable(10),w.vertexAlphas&&o.enable(11),w.vertexUv1s&&o.enable(12),w.vertexUv2s&&o.enable(13),w.vertexUv3s&&o.enable(14),w.vertexTangents&&o.enable(15),w.anisotropy&&o.enable(16),w.alphaHash&&o.enable(17),w.batching&&o.enable(18),w.dispersion&&o.enable(19),w.retroreflection&&o.enable(24),w.diffuseRoughness&&o.enable(25),w.batchingColor&&o.enable(20),w.gradientMap&&o.enable(21),w.packedNormalMap&&o.enable(22),w.vertexNormals&&o.enable(23),x.push(o.mask),o.disableAll(),w.fog&&o.enable(0),w.useFog&&o.enable(1),w.flatShading&&o.enable(2),w.logarithmicDepthBuffer&&o.enable(3),w.reversedDepthBuffer&&o.enable(4),w.skinning&&o.enable(5),w.morphTargets&&o.enable(6),w.morphNormals&&o.enable(7),w.morphColors&&o.enable(8),w.premultipliedAlpha&&o.enable(9),w.shadowMapEnabled&&o.enable(10),w.doubleSided&&o.enable(11),w.flipSided&&o.enable(12),w.useDepthPacking&&o.enable(13),w.dithering&&o.enable(14),w.transmission&&o.enable(15),w.sheen&&o.enable(16),w.opaque&&o.enable(17),w.pointsUvs&&o.enable(18),w.decodeVideoTexture&&o.enable(19),w.decodeVideoTextureEmissive&&o.enable(20),w.alphaToCoverage&&o.enable(21),w.numLightProbeGrids>0&&o.enable(22),w.hasPositionAttribute&&o.enable(23),x.push(o.mask)}function y(x){let w=u[x.type],O;if(w){let P=fi[w];O=ml.clone(P.uniforms)}else O=x.uniforms;return O}function T(x,w){let O=d.get(w);return O!==void 0?++O.usedTimes:(O=new fb(i,w,x,s),c.push(O),d.set(w,O)),O}function v(x){if(--x.usedTimes===0){let w=c.indexOf(x);c[w]=c[c.length-1],c.pop(),d.delete(x.cacheKey),x.destroy()}}function M(x){a.remove(x)}function b(){a.dispose()}return{getParameters:p,getProgramCacheKey:_,getUniforms:y,acquireProgram:T,releaseProgram:v,releaseShaderCache:M,programs:c,dispose:b}}function _b(){let i=new WeakMap;function t(o){return i.has(o)}function e(o){let a=i.get(o);return a===void 0&&(a={},i.set(o,a)),a}function n(o){i.delete(o)}function s(o,a,l){i.get(o)[a]=l}function r(){i=new WeakMap}return{has:t,get:e,remove:n,update:s,dispose:r}}function xb(i,t){return i.groupOrder!==t.groupOrder?i.groupOrder-t.groupOrder:i.renderOrder!==t.renderOrder?i.renderOrder-t.renderOrder:i.material.id!==t.material.id?i.material.id-t.material.id:i.materialVariant!==t.materialVariant?i.materialVariant-t.materialVariant:i.z!==t.z?i.z-t.z:i.id-t.id}function Fg(i,t){return i.groupOrder!==t.groupOrder?i.groupOrder-t.groupOrder:i.renderOrder!==t.renderOrder?i.renderOrder-t.renderOrder:i.z!==t.z?t.z-i.z:i.id-t.id}function Bg(){let i=[],t=0,e=[],n=[],s=[];function r(){t=0,e.length=0,n.length=0,s.length=0}function o(u){let f=0;return u.isInstancedMesh&&(f+=2),u.isSkinnedMesh&&(f+=1),f}function a(u,f,p,_,m,g){let y=i[t];return y===void 0?(y={id:u.id,object:u,geometry:f,material:p,materialVariant:o(u),groupOrder:_,renderOrder:u.renderOrder,z:m,group:g},i[t]=y):(y.id=u.id,y.object=u,y.geometry=f,y.material=p,y.materialVariant=o(u),y.groupOrder=_,y.renderOrder=u.renderOrder,y.z=m,y.group=g),t++,y}function l(u,f,p,_,m,g,y){y.reversedDepth===!0&&(m=-m);let T=a(u,f,p,_,m,g);p.transmission>0?n.push(T):p.transparent===!0?s.push(T):e.push(T)}function c(u,f,p,_,m,g){let y=a(u,f,p,_,m,g);p.transmission>0?n.unshift(y):p.transparent===!0?s.unshift(y):e.unshift(y)}function d(u,f){e.length>1&&e.sort(u||xb),n.length>1&&n.sort(f||Fg),s.length>1&&s.sort(f||Fg)}function h(){for(let u=t,f=i.length;u<f;u++){let p=i[u];if(p.id===null)break;p.id=null,p.object=null,p.geometry=null,p.material=null,p.group=null}}return{opaque:e,transmissive:n,transparent:s,init:r,push:l,unshift:c,finish:h,sort:d}}function yb(){let i=new WeakMap;function t(n,s){let r=i.get(n),o;return r===void 0?(o=new Bg,i.set(n,[o])):s>=r.length?(o=new Bg,r.push(o)):o=r[s],o}function e(){i=new WeakMap}return{get:t,dispose:e}}function vb(){let i={};return{get:function(t){if(i[t.id]!==void 0)return i[t.id];let e;switch(t.type){case"SunLight":case"DirectionalLight":e={direction:new R,color:new Xt};break;case"SpotLight":e={position:new R,direction:new R,color:new Xt,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":e={position:new R,color:new Xt,distance:0,decay:0};break;case"HemisphereLight":e={direction:new R,skyColor:new Xt,groundColor:new Xt};break;case"RectAreaLight":e={color:new Xt,position:new R,halfWidth:new R,halfHeight:new R};break}return i[t.id]=e,e}}}function Sb(){let i={};return{get:function(t){if(i[t.id]!==void 0)return i[t.id];let e;switch(t.type){case"SunLight":case"DirectionalLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Bt};break;case"SpotLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Bt};break;case"PointLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Bt,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[t.id]=e,e}}}var Mb=0;function wb(i,t){return(t.castShadow?2:0)-(i.castShadow?2:0)+(t.map?1:0)-(i.map?1:0)}function bb(i){let t=new vb,e=Sb(),n={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)n.probe.push(new R);let s=new R,r=new Wt,o=new Wt;function a(c){let d=0,h=0,u=0;for(let B=0;B<9;B++)n.probe[B].set(0,0,0);let f=0,p=0,_=0,m=0,g=0,y=0,T=0,v=0,M=0,b=0,x=0,w=0,O=0,P=0;c.sort(wb);for(let B=0,G=c.length;B<G;B++){let D=c[B],X=D.color,Z=D.intensity,W=D.distance,at=null;if(D.shadow&&D.shadow.map&&(D.shadow.map.texture.format===fr?at=D.shadow.map.texture:at=D.shadow.map.depthTexture||D.shadow.map.texture),D.isAmbientLight)d+=X.r*Z,h+=X.g*Z,u+=X.b*Z;else if(D.isLightProbe){for(let k=0;k<9;k++)n.probe[k].addScaledVector(D.sh.coefficients[k],Z);P++}else if(D.isSunLight){let k=t.get(D);if(k.color.copy(D.color).multiplyScalar(D.intensity),D.castShadow){let q=D.shadow,Q=e.get(D);Q.shadowIntensity=q.intensity,Q.shadowBias=q.bias,Q.shadowNormalBias=q.normalBias,Q.shadowRadius=q.radius,Q.shadowMapSize.copy(q.mapSize).multiply(q.getFrameExtents()),n.sunShadow[p]=Q,n.sunShadowMap[p]=at;let lt=q.getViewportCount();for(let ht=0;ht<lt;ht++)n.sunShadowMatrix[_+ht]=q.getMatrix(ht),n.sunShadowCascade[_+ht]=q._cascadeData[ht];_+=lt,p++}n.sun[f]=k,f++}else if(D.isDirectionalLight){let k=t.get(D);if(k.color.copy(D.color).multiplyScalar(D.intensity),D.castShadow){let q=D.shadow,Q=e.get(D);Q.shadowIntensity=q.intensity,Q.shadowBias=q.bias,Q.shadowNormalBias=q.normalBias,Q.shadowRadius=q.radius,Q.shadowMapSize=q.mapSize,n.directionalShadow[m]=Q,n.directionalShadowMap[m]=at,n.directionalShadowMatrix[m]=D.shadow.matrix,M++}n.directional[m]=k,m++}else if(D.isSpotLight){let k=t.get(D);k.position.setFromMatrixPosition(D.matrixWorld),k.color.copy(X).multiplyScalar(Z),k.distance=W,k.coneCos=Math.cos(D.angle),k.penumbraCos=Math.cos(D.angle*(1-D.penumbra)),k.decay=D.decay,n.spot[y]=k;let q=D.shadow;if(D.map&&(n.spotLightMap[w]=D.map,w++,q.updateMatrices(D),D.castShadow&&O++),n.spotLightMatrix[y]=q.matrix,D.castShadow){let Q=e.get(D);Q.shadowIntensity=q.intensity,Q.shadowBias=q.bias,Q.shadowNormalBias=q.normalBias,Q.shadowRadius=q.radius,Q.shadowMapSize=q.mapSize,n.spotShadow[y]=Q,n.spotShadowMap[y]=at,x++}y++}else if(D.isRectAreaLight){let k=t.get(D);k.color.copy(X).multiplyScalar(Z),k.halfWidth.set(D.width*.5,0,0),k.halfHeight.set(0,D.height*.5,0),n.rectArea[T]=k,T++}else if(D.isPointLight){let k=t.get(D);if(k.color.copy(D.color).multiplyScalar(D.intensity),k.distance=D.distance,k.decay=D.decay,D.castShadow){let q=D.shadow,Q=e.get(D);Q.shadowIntensity=q.intensity,Q.shadowBias=q.bias,Q.shadowNormalBias=q.normalBias,Q.shadowRadius=q.radius,Q.shadowMapSize=q.mapSize,Q.shadowCameraNear=q.camera.near,Q.shadowCameraFar=q.camera.far,n.pointShadow[g]=Q,n.pointShadowMap[g]=at,n.pointShadowMatrix[g]=D.shadow.matrix,b++}n.point[g]=k,g++}else if(D.isHemisphereLight){let k=t.get(D);k.skyColor.copy(D.color).multiplyScalar(Z),k.groundColor.copy(D.groundColor).multiplyScalar(Z),n.hemi[v]=k,v++}}T>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=It.LTC_FLOAT_1,n.rectAreaLTC2=It.LTC_FLOAT_2):(n.rectAreaLTC1=It.LTC_HALF_1,n.rectAreaLTC2=It.LTC_HALF_2)),n.ambient[0]=d,n.ambient[1]=h,n.ambient[2]=u;let L=n.hash;(L.sunLength!==f||L.directionalLength!==m||L.pointLength!==g||L.spotLength!==y||L.rectAreaLength!==T||L.hemiLength!==v||L.numSunShadows!==p||L.numDirectionalShadows!==M||L.numPointShadows!==b||L.numSpotShadows!==x||L.numSpotMaps!==w||L.numLightProbes!==P)&&(n.sun.length=f,n.directional.length=m,n.spot.length=y,n.rectArea.length=T,n.point.length=g,n.hemi.length=v,n.sunShadow.length=p,n.sunShadowMap.length=p,n.sunShadowMatrix.length=_,n.sunShadowCascade.length=_,n.directionalShadow.length=M,n.directionalShadowMap.length=M,n.directionalShadowMatrix.length=M,n.pointShadow.length=b,n.pointShadowMap.length=b,n.pointShadowMatrix.length=b,n.spotShadow.length=x,n.spotShadowMap.length=x,n.spotLightMatrix.length=x+w-O,n.spotLightMap.length=w,n.numSpotLightShadowsWithMaps=O,n.numLightProbes=P,L.sunLength=f,L.directionalLength=m,L.pointLength=g,L.spotLength=y,L.rectAreaLength=T,L.hemiLength=v,L.numSunShadows=p,L.numDirectionalShadows=M,L.numPointShadows=b,L.numSpotShadows=x,L.numSpotMaps=w,L.numLightProbes=P,n.version=Mb++)}function l(c,d){let h=0,u=0,f=0,p=0,_=0,m=0,g=d.matrixWorldInverse;for(let y=0,T=c.length;y<T;y++){let v=c[y];if(v.isSunLight){let M=n.sun[h];M.direction.setFromMatrixPosition(v.matrixWorld),M.direction.transformDirection(g),h++}else if(v.isDirectionalLight){let M=n.directional[u];M.direction.setFromMatrixPosition(v.matrixWorld),s.setFromMatrixPosition(v.target.matrixWorld),M.direction.sub(s),M.direction.transformDirection(g),u++}else if(v.isSpotLight){let M=n.spot[p];M.position.setFromMatrixPosition(v.matrixWorld),M.position.applyMatrix4(g),M.direction.setFromMatrixPosition(v.matrixWorld),s.setFromMatrixPosition(v.target.matrixWorld),M.direction.sub(s),M.direction.transformDirection(g),p++}else if(v.isRectAreaLight){let M=n.rectArea[_];M.position.setFromMatrixPosition(v.matrixWorld),M.position.applyMatrix4(g),o.identity(),r.copy(v.matrixWorld),r.premultiply(g),o.extractRotation(r),M.halfWidth.set(v.width*.5,0,0),M.halfHeight.set(0,v.height*.5,0),M.halfWidth.applyMatrix4(o),M.halfHeight.applyMatrix4(o),_++}else if(v.isPointLight){let M=n.point[f];M.position.setFromMatrixPosition(v.matrixWorld),M.position.applyMatrix4(g),f++}else if(v.isHemisphereLight){let M=n.hemi[m];M.direction.setFromMatrixPosition(v.matrixWorld),M.direction.transformDirection(g),m++}}}return{setup:a,setupView:l,state:n}}function kg(i){let t=new bb(i),e=[],n=[],s=[];function r(h){d.camera=h,e.length=0,n.length=0,s.length=0}function o(h){h.isLightProbeGrid?s.push(h):e.push(h)}function a(h){n.push(h)}function l(){t.setup(e),s.sort((h,u)=>h.priority-u.priority||h.id-u.id)}function c(h){t.setupView(e,h)}let d={lightsArray:e,shadowsArray:n,lightProbeGridArray:s,camera:null,lights:t,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:d,setupLights:l,setupLightsView:c,pushLight:o,pushShadow:a}}function Tb(i){let t=new WeakMap;function e(s,r=0){let o=t.get(s),a;return o===void 0?(a=new kg(i),t.set(s,[a])):r>=o.length?(a=new kg(i),o.push(a)):a=o[r],a}function n(){t=new WeakMap}return{get:e,dispose:n}}var Eb=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,Ab=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,Cb=[new R(1,0,0),new R(-1,0,0),new R(0,1,0),new R(0,-1,0),new R(0,0,1),new R(0,0,-1)],Rb=[new R(0,-1,0),new R(0,-1,0),new R(0,0,1),new R(0,0,-1),new R(0,-1,0),new R(0,-1,0)],zg=new Wt,gl=new R,hf=new R;function Pb(i,t,e){let n=new nr,s=new Bt,r=new Bt,o=new De,a=new Nc,l=new Oc,c={},d=e.maxTextureSize,h={[dr]:Yn,[Yn]:dr,[Mn]:Mn},u=new ui({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new Bt},radius:{value:4}},vertexShader:Eb,fragmentShader:Ab}),f=u.clone();f.defines.HORIZONTAL_PASS=1;let p=new pe;p.setAttribute("position",new Le(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let _=new St(p,u),m=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=Ir;let g=this.type;this.render=function(b,x,w){if(m.enabled===!1||m.autoUpdate===!1&&m.needsUpdate===!1||b.length===0)return;this.type===Um&&(jt("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=Ir);let O=i.getRenderTarget(),P=i.getActiveCubeFace(),L=i.getActiveMipmapLevel(),B=i.state;B.setBlending(Lr),B.buffers.depth.getReversed()===!0?B.buffers.color.setClear(0,0,0,0):B.buffers.color.setClear(1,1,1,1),B.buffers.depth.setTest(!0),B.setScissorTest(!1);let G=g!==this.type;G&&x.traverse(function(D){D.material&&(Array.isArray(D.material)?D.material.forEach(X=>X.needsUpdate=!0):D.material.needsUpdate=!0)});for(let D=0,X=b.length;D<X;D++){let Z=b[D],W=Z.shadow;if(W===void 0){jt("WebGLShadowMap:",Z,"has no shadow.");continue}if(W.autoUpdate===!1&&W.needsUpdate===!1)continue;s.copy(W.mapSize);let at=W.getFrameExtents();s.multiply(at),r.copy(W.mapSize),(s.x>d||s.y>d)&&(s.x>d&&(r.x=Math.floor(d/at.x),s.x=r.x*at.x,W.mapSize.x=r.x),s.y>d&&(r.y=Math.floor(d/at.y),s.y=r.y*at.y,W.mapSize.y=r.y));let k=i.state.buffers.depth.getReversed();if(W.camera._reversedDepth=k,W.map===null||G===!0){if(W.map!==null&&(W.map.depthTexture!==null&&(W.map.depthTexture.dispose(),W.map.depthTexture=null),W.map.dispose()),this.type===Vo){if(Z.isPointLight){jt("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}W.map=new Xn(s.x,s.y,{format:fr,type:Ji,minFilter:ci,magFilter:ci,generateMipmaps:!1}),W.map.texture.name=Z.name+".shadowMap",W.map.depthTexture=new Fs(s.x,s.y,Fi),W.map.depthTexture.name=Z.name+".shadowMapDepth",W.map.depthTexture.format=Ds,W.map.depthTexture.compareFunction=null,W.map.depthTexture.minFilter=zn,W.map.depthTexture.magFilter=zn}else Z.isPointLight?(W.map=new xl(s.x),W.map.depthTexture=new Wa(s.x,Zi)):(W.map=new Xn(s.x,s.y),W.map.depthTexture=new Fs(s.x,s.y,Zi)),W.map.depthTexture.name=Z.name+".shadowMap",W.map.depthTexture.format=Ds,this.type===Ir?(W.map.depthTexture.compareFunction=k?Jd:Zd,W.map.depthTexture.minFilter=ci,W.map.depthTexture.magFilter=ci):(W.map.depthTexture.compareFunction=null,W.map.depthTexture.minFilter=zn,W.map.depthTexture.magFilter=zn);W.camera.updateProjectionMatrix()}W.map.isWebGLCubeRenderTarget!==!0&&(W.map.width!==s.x||W.map.height!==s.y)&&W.map.setSize(s.x,s.y);let q=W.map.isWebGLCubeRenderTarget?6:W.getViewportCount();Z.isPointLight!==!0&&W.updateMatrices(Z,w);let Q=(W.camera.layers.mask&4294967294)!==0?W.camera.layers:w.layers;for(let lt=0;lt<q;lt++){let ht=W.getCamera(lt);if(Z.isPointLight){let et=W.camera,mt=W.matrix,xt=Z.distance||et.far;xt!==et.far&&(et.far=xt,et.updateProjectionMatrix()),gl.setFromMatrixPosition(Z.matrixWorld),et.position.copy(gl),hf.copy(et.position),hf.add(Cb[lt]),et.up.copy(Rb[lt]),et.lookAt(hf),et.updateMatrixWorld(),mt.makeTranslation(-gl.x,-gl.y,-gl.z),zg.multiplyMatrices(et.projectionMatrix,et.matrixWorldInverse),W._frustum.setFromProjectionMatrix(zg,et.coordinateSystem,et.reversedDepth)}if(W.map.isWebGLCubeRenderTarget)i.setRenderTarget(W.map,lt),i.clear();else{lt===0&&(i.setRenderTarget(W.map),i.clear());let et=W.getViewport(lt);o.set(r.x*et.x,r.y*et.y,r.x*et.z,r.y*et.w),B.viewport(o)}n=W.getFrustum(lt),v(x,w,ht,Z,Q,this.type)}W.isPointLightShadow!==!0&&this.type===Vo&&y(W,w),W.needsUpdate=!1}g=this.type,m.needsUpdate=!1,i.setRenderTarget(O,P,L)};function y(b,x){let w=t.update(_);u.defines.VSM_SAMPLES!==b.blurSamples&&(u.defines.VSM_SAMPLES=b.blurSamples,f.defines.VSM_SAMPLES=b.blurSamples,u.needsUpdate=!0,f.needsUpdate=!0),b.mapPass===null?b.mapPass=new Xn(s.x,s.y,{format:fr,type:Ji}):(b.mapPass.width!==b.map.width||b.mapPass.height!==b.map.height)&&b.mapPass.setSize(b.map.width,b.map.height),u.uniforms.shadow_pass.value=b.map.depthTexture,u.uniforms.resolution.value.set(b.map.width,b.map.height),u.uniforms.radius.value=b.radius,i.setRenderTarget(b.mapPass),i.clear(),i.renderBufferDirect(x,null,w,u,_,null),f.uniforms.shadow_pass.value=b.mapPass.texture,f.uniforms.resolution.value.set(b.map.width,b.map.height),f.uniforms.radius.value=b.radius,i.setRenderTarget(b.map),i.clear(),i.renderBufferDirect(x,null,w,f,_,null)}function T(b,x,w,O){let P=null,L=w.isPointLight===!0?b.customDistanceMaterial:b.customDepthMaterial;if(L!==void 0)P=L;else if(P=w.isPointLight===!0?l:a,i.localClippingEnabled&&x.clipShadows===!0&&Array.isArray(x.clippingPlanes)&&x.clippingPlanes.length!==0||x.displacementMap&&x.displacementScale!==0||x.alphaMap&&x.alphaTest>0||x.map&&x.alphaTest>0||x.alphaToCoverage===!0){let B=P.uuid,G=x.uuid,D=c[B];D===void 0&&(D={},c[B]=D);let X=D[G];X===void 0&&(X=P.clone(),D[G]=X,x.addEventListener("dispose",M)),P=X}if(P.visible=x.visible,P.wireframe=x.wireframe,O===Vo?P.side=x.shadowSide!==null?x.shadowSide:x.side:P.side=x.shadowSide!==null?x.shadowSide:h[x.side],P.alphaMap=x.alphaMap,P.alphaTest=x.alphaToCoverage===!0?.5:x.alphaTest,P.map=x.map,P.clipShadows=x.clipShadows,P.clippingPlanes=x.clippingPlanes,P.clipIntersection=x.clipIntersection,P.displacementMap=x.displacementMap,P.displacementScale=x.displacementScale,P.displacementBias=x.displacementBias,P.wireframeLinewidth=x.wireframeLinewidth,P.linewidth=x.linewidth,w.isPointLight===!0&&P.isMeshDistanceMaterial===!0){let B=i.properties.get(P);B.light=w}return P}function v(b,x,w,O,P,L){if(b.visible===!1)return;if(b.layers.test(P)&&(b.isMesh||b.isLine||b.isPoints)&&(b.castShadow||b.receiveShadow&&L===Vo)&&(!b.frustumCulled||b.intersectsFrustum(n))){b.modelViewMatrix.multiplyMatrices(w.matrixWorldInverse,b.matrixWorld);let D=t.update(b),X=b.material;if(Array.isArray(X)){let Z=D.groups;for(let W=0,at=Z.length;W<at;W++){let k=Z[W],q=X[k.materialIndex];if(q&&q.visible){let Q=T(b,q,O,L);b.onBeforeShadow(i,b,x,w,D,Q,k),i.renderBufferDirect(w,null,D,Q,b,k),b.onAfterShadow(i,b,x,w,D,Q,k)}}}else if(X.visible){let Z=T(b,X,O,L);b.onBeforeShadow(i,b,x,w,D,Z,null),i.renderBufferDirect(w,null,D,Z,b,null),b.onAfterShadow(i,b,x,w,D,Z,null)}}let G=b.children;for(let D=0,X=G.length;D<X;D++)v(G[D],x,w,O,P,L)}function M(b){b.target.removeEventListener("dispose",M);for(let w in c){let O=c[w],P=b.target.uuid;P in O&&(O[P].dispose(),delete O[P])}}}function Ib(i,t){function e(){let z=!1,rt=new De,it=null,Tt=new De(0,0,0,0);return{setMask:function(gt){it!==gt&&!z&&(i.colorMask(gt,gt,gt,gt),it=gt)},setLocked:function(gt){z=gt},setClear:function(gt,Mt,qt,ee,ut){ut===!0&&(gt*=ee,Mt*=ee,qt*=ee),rt.set(gt,Mt,qt,ee),Tt.equals(rt)===!1&&(i.clearColor(gt,Mt,qt,ee),Tt.copy(rt))},reset:function(){z=!1,it=null,Tt.set(-1,0,0,0)}}}function n(){let z=!1,rt=!1,it=null,Tt=null,gt=null;return{setReversed:function(Mt){if(rt!==Mt){let qt=t.get("EXT_clip_control");Mt?qt.clipControlEXT(qt.LOWER_LEFT_EXT,qt.ZERO_TO_ONE_EXT):qt.clipControlEXT(qt.LOWER_LEFT_EXT,qt.NEGATIVE_ONE_TO_ONE_EXT),rt=Mt;let ee=gt;gt=null,this.setClear(ee)}},getReversed:function(){return rt},setTest:function(Mt){Mt?wt(i.DEPTH_TEST):$t(i.DEPTH_TEST)},setMask:function(Mt){it!==Mt&&!z&&(i.depthMask(Mt),it=Mt)},setFunc:function(Mt){if(rt&&(Mt=mg[Mt]),Tt!==Mt){switch(Mt){case _c:i.depthFunc(i.NEVER);break;case xc:i.depthFunc(i.ALWAYS);break;case yc:i.depthFunc(i.LESS);break;case Ao:i.depthFunc(i.LEQUAL);break;case vc:i.depthFunc(i.EQUAL);break;case Sc:i.depthFunc(i.GEQUAL);break;case Mc:i.depthFunc(i.GREATER);break;case wc:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}Tt=Mt}},setLocked:function(Mt){z=Mt},setClear:function(Mt){gt!==Mt&&(gt=Mt,rt&&(Mt=1-Mt),i.clearDepth(Mt))},reset:function(){z=!1,it=null,Tt=null,gt=null,rt=!1}}}function s(){let z=!1,rt=null,it=null,Tt=null,gt=null,Mt=null,qt=null,ee=null,ut=null;return{setTest:function(zt){z||(zt?wt(i.STENCIL_TEST):$t(i.STENCIL_TEST))},setMask:function(zt){rt!==zt&&!z&&(i.stencilMask(zt),rt=zt)},setFunc:function(zt,ne,Rt){(it!==zt||Tt!==ne||gt!==Rt)&&(i.stencilFunc(zt,ne,Rt),it=zt,Tt=ne,gt=Rt)},setOp:function(zt,ne,Rt){(Mt!==zt||qt!==ne||ee!==Rt)&&(i.stencilOp(zt,ne,Rt),Mt=zt,qt=ne,ee=Rt)},setLocked:function(zt){z=zt},setClear:function(zt){ut!==zt&&(i.clearStencil(zt),ut=zt)},reset:function(){z=!1,rt=null,it=null,Tt=null,gt=null,Mt=null,qt=null,ee=null,ut=null}}}let r=new e,o=new n,a=new s,l={},c=new WeakMap,d={},h={},u={},f=new WeakMap,p=[],_=null,m=!1,g=null,y=null,T=null,v=null,M=null,b=null,x=null,w=new Xt(0,0,0),O=0,P=!1,L=null,B=null,G=null,D=null,X=null,Z=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS),W=!1,at=0,k=i.getParameter(i.VERSION);k.indexOf("WebGL")!==-1?(at=parseFloat(/^WebGL (\d)/.exec(k)[1]),W=at>=1):k.indexOf("OpenGL ES")!==-1&&(at=parseFloat(/^OpenGL ES (\d)/.exec(k)[1]),W=at>=2);let q=null,Q={},lt=i.getParameter(i.SCISSOR_BOX),ht=i.getParameter(i.VIEWPORT),et=new De().fromArray(lt),mt=new De().fromArray(ht);function xt(z,rt,it,Tt){let gt=new Uint8Array(4),Mt=i.createTexture();i.bindTexture(z,Mt),i.texParameteri(z,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(z,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let qt=0;qt<it;qt++)z===i.TEXTURE_3D||z===i.TEXTURE_2D_ARRAY?i.texImage3D(rt,0,i.RGBA,1,1,Tt,0,i.RGBA,i.UNSIGNED_BYTE,gt):i.texImage2D(rt+qt,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,gt);return Mt}let Ct={};Ct[i.TEXTURE_2D]=xt(i.TEXTURE_2D,i.TEXTURE_2D,1),Ct[i.TEXTURE_CUBE_MAP]=xt(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),Ct[i.TEXTURE_2D_ARRAY]=xt(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),Ct[i.TEXTURE_3D]=xt(i.TEXTURE_3D,i.TEXTURE_3D,1,1),r.setClear(0,0,0,1),o.setClear(1),a.setClear(0),wt(i.DEPTH_TEST),o.setFunc(Ao),mn(!1),Be(Rd),wt(i.CULL_FACE),Qe(Lr);function wt(z){d[z]!==!0&&(i.enable(z),d[z]=!0)}function $t(z){d[z]!==!1&&(i.disable(z),d[z]=!1)}function le(z,rt){return u[z]!==rt?(i.bindFramebuffer(z,rt),u[z]=rt,z===i.DRAW_FRAMEBUFFER&&(u[i.FRAMEBUFFER]=rt),z===i.FRAMEBUFFER&&(u[i.DRAW_FRAMEBUFFER]=rt),!0):!1}function Yt(z,rt){let it=p,Tt=!1;if(z){it=f.get(rt),it===void 0&&(it=[],f.set(rt,it));let gt=z.textures;if(it.length!==gt.length||it[0]!==i.COLOR_ATTACHMENT0){for(let Mt=0,qt=gt.length;Mt<qt;Mt++)it[Mt]=i.COLOR_ATTACHMENT0+Mt;it.length=gt.length,Tt=!0}}else it[0]!==i.BACK&&(it[0]=i.BACK,Tt=!0);Tt&&i.drawBuffers(it)}function ge(z){return _!==z?(i.useProgram(z),_=z,!0):!1}let de={[Dr]:i.FUNC_ADD,[Bm]:i.FUNC_SUBTRACT,[km]:i.FUNC_REVERSE_SUBTRACT};de[zm]=i.MIN,de[Vm]=i.MAX;let oe={[Gm]:i.ZERO,[Hm]:i.ONE,[Wm]:i.SRC_COLOR,[Dd]:i.SRC_ALPHA,[Jm]:i.SRC_ALPHA_SATURATE,[$m]:i.DST_COLOR,[Ym]:i.DST_ALPHA,[Xm]:i.ONE_MINUS_SRC_COLOR,[Nd]:i.ONE_MINUS_SRC_ALPHA,[Zm]:i.ONE_MINUS_DST_COLOR,[qm]:i.ONE_MINUS_DST_ALPHA,[jm]:i.CONSTANT_COLOR,[Km]:i.ONE_MINUS_CONSTANT_COLOR,[Qm]:i.CONSTANT_ALPHA,[tg]:i.ONE_MINUS_CONSTANT_ALPHA};function Qe(z,rt,it,Tt,gt,Mt,qt,ee,ut,zt){if(z===Lr){m===!0&&($t(i.BLEND),m=!1);return}if(m===!1&&(wt(i.BLEND),m=!0),z!==Fm){if(z!==g||zt!==P){if((y!==Dr||M!==Dr)&&(i.blendEquation(i.FUNC_ADD),y=Dr,M=Dr),zt)switch(z){case Go:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case Pd:i.blendFunc(i.ONE,i.ONE);break;case Id:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case Ld:i.blendFuncSeparate(i.DST_COLOR,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE);break;default:te("WebGLState: Invalid blending: ",z);break}else switch(z){case Go:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case Pd:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE,i.ONE,i.ONE);break;case Id:te("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case Ld:te("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:te("WebGLState: Invalid blending: ",z);break}T=null,v=null,b=null,x=null,w.set(0,0,0),O=0,g=z,P=zt}return}gt=gt||rt,Mt=Mt||it,qt=qt||Tt,(rt!==y||gt!==M)&&(i.blendEquationSeparate(de[rt],de[gt]),y=rt,M=gt),(it!==T||Tt!==v||Mt!==b||qt!==x)&&(i.blendFuncSeparate(oe[it],oe[Tt],oe[Mt],oe[qt]),T=it,v=Tt,b=Mt,x=qt),(ee.equals(w)===!1||ut!==O)&&(i.blendColor(ee.r,ee.g,ee.b,ut),w.copy(ee),O=ut),g=z,P=!1}function Xe(z,rt){z.side===Mn?$t(i.CULL_FACE):wt(i.CULL_FACE);let it=z.side===Yn;rt&&(it=!it),mn(it),z.blending===Go&&z.transparent===!1?Qe(Lr):Qe(z.blending,z.blendEquation,z.blendSrc,z.blendDst,z.blendEquationAlpha,z.blendSrcAlpha,z.blendDstAlpha,z.blendColor,z.blendAlpha,z.premultipliedAlpha),o.setFunc(z.depthFunc),o.setTest(z.depthTest),o.setMask(z.depthWrite),r.setMask(z.colorWrite);let Tt=z.stencilWrite;a.setTest(Tt),Tt&&(a.setMask(z.stencilWriteMask),a.setFunc(z.stencilFunc,z.stencilRef,z.stencilFuncMask),a.setOp(z.stencilFail,z.stencilZFail,z.stencilZPass)),we(z.polygonOffset,z.polygonOffsetFactor,z.polygonOffsetUnits),z.alphaToCoverage===!0?wt(i.SAMPLE_ALPHA_TO_COVERAGE):$t(i.SAMPLE_ALPHA_TO_COVERAGE)}function mn(z){L!==z&&(z?i.frontFace(i.CW):i.frontFace(i.CCW),L=z)}function Be(z){z!==Nm?(wt(i.CULL_FACE),z!==B&&(z===Rd?i.cullFace(i.BACK):z===Om?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):$t(i.CULL_FACE),B=z}function Nn(z){z!==G&&(W&&i.lineWidth(z),G=z)}function we(z,rt,it){z?(wt(i.POLYGON_OFFSET_FILL),(D!==rt||X!==it)&&(D=rt,X=it,o.getReversed()&&(rt=-rt,it=-it),i.polygonOffset(rt,it))):$t(i.POLYGON_OFFSET_FILL)}function bn(z){z?wt(i.SCISSOR_TEST):$t(i.SCISSOR_TEST)}function an(z){z===void 0&&(z=i.TEXTURE0+Z-1),q!==z&&(i.activeTexture(z),q=z)}function gn(z,rt,it){it===void 0&&(q===null?it=i.TEXTURE0+Z-1:it=q);let Tt=Q[it];Tt===void 0&&(Tt={type:void 0,texture:void 0},Q[it]=Tt),(Tt.type!==z||Tt.texture!==rt)&&(q!==it&&(i.activeTexture(it),q=it),i.bindTexture(z,rt||Ct[z]),Tt.type=z,Tt.texture=rt)}function V(){let z=Q[q];z!==void 0&&z.type!==void 0&&(i.bindTexture(z.type,null),z.type=void 0,z.texture=void 0)}function Pt(){try{i.compressedTexImage2D(...arguments)}catch(z){te("WebGLState:",z)}}function Kt(){try{i.compressedTexImage3D(...arguments)}catch(z){te("WebGLState:",z)}}function ce(){try{i.texSubImage2D(...arguments)}catch(z){te("WebGLState:",z)}}function bt(){try{i.texSubImage3D(...arguments)}catch(z){te("WebGLState:",z)}}function Ve(){try{i.compressedTexSubImage2D(...arguments)}catch(z){te("WebGLState:",z)}}function Ht(){try{i.compressedTexSubImage3D(...arguments)}catch(z){te("WebGLState:",z)}}function Jt(){try{i.texStorage2D(...arguments)}catch(z){te("WebGLState:",z)}}function I(){try{i.texStorage3D(...arguments)}catch(z){te("WebGLState:",z)}}function E(){try{i.texImage2D(...arguments)}catch(z){te("WebGLState:",z)}}function $(){try{i.texImage3D(...arguments)}catch(z){te("WebGLState:",z)}}function dt(z){return h[z]!==void 0?h[z]:i.getParameter(z)}function ot(z,rt){h[z]!==rt&&(i.pixelStorei(z,rt),h[z]=rt)}function _t(z){et.equals(z)===!1&&(i.scissor(z.x,z.y,z.z,z.w),et.copy(z))}function yt(z){mt.equals(z)===!1&&(i.viewport(z.x,z.y,z.z,z.w),mt.copy(z))}function nt(z,rt){let it=c.get(rt);it===void 0&&(it=new WeakMap,c.set(rt,it));let Tt=it.get(z);Tt===void 0&&(Tt=i.getUniformBlockIndex(rt,z.name),i.uniformBlockBinding(rt,Tt,Tt),it.set(z,Tt))}function st(z,rt,it){let gt=c.get(rt).get(z);l[gt]!==it&&(i.bindBufferBase(i.UNIFORM_BUFFER,gt,it),l[gt]=it)}function pt(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),o.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),i.pixelStorei(i.PACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,!1),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,i.BROWSER_DEFAULT_WEBGL),i.pixelStorei(i.PACK_ROW_LENGTH,0),i.pixelStorei(i.PACK_SKIP_PIXELS,0),i.pixelStorei(i.PACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_ROW_LENGTH,0),i.pixelStorei(i.UNPACK_IMAGE_HEIGHT,0),i.pixelStorei(i.UNPACK_SKIP_PIXELS,0),i.pixelStorei(i.UNPACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_SKIP_IMAGES,0),d={},h={},q=null,Q={},u={},l={},f=new WeakMap,p=[],_=null,m=!1,g=null,y=null,T=null,v=null,M=null,b=null,x=null,w=new Xt(0,0,0),O=0,P=!1,L=null,B=null,G=null,D=null,X=null,et.set(0,0,i.canvas.width,i.canvas.height),mt.set(0,0,i.canvas.width,i.canvas.height),r.reset(),o.reset(),a.reset()}return{buffers:{color:r,depth:o,stencil:a},enable:wt,disable:$t,bindFramebuffer:le,drawBuffers:Yt,useProgram:ge,setBlending:Qe,setMaterial:Xe,setFlipSided:mn,setCullFace:Be,setLineWidth:Nn,setPolygonOffset:we,setScissorTest:bn,activeTexture:an,bindTexture:gn,unbindTexture:V,compressedTexImage2D:Pt,compressedTexImage3D:Kt,texImage2D:E,texImage3D:$,pixelStorei:ot,getParameter:dt,updateUBOMapping:nt,uniformBlockBinding:st,texStorage2D:Jt,texStorage3D:I,texSubImage2D:ce,texSubImage3D:bt,compressedTexSubImage2D:Ve,compressedTexSubImage3D:Ht,scissor:_t,viewport:yt,reset:pt}}function Lb(i,t,e,n,s,r,o){let a=t.has("WEBGL_multisampled_render_to_texture")?t.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new Bt,d=new WeakMap,h=new Set,u,f=new WeakMap,p=new Set,_=new FinalizationRegistry(I=>p.delete(I)),m=!1;try{m=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function g(I,E){return m?new OffscreenCanvas(I,E):Da("canvas")}function y(I,E,$){let dt=1,ot=Jt(I);if((ot.width>$||ot.height>$)&&(dt=$/Math.max(ot.width,ot.height)),dt<1)if(typeof HTMLImageElement<"u"&&I instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&I instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&I instanceof ImageBitmap||typeof VideoFrame<"u"&&I instanceof VideoFrame){let _t=Math.floor(dt*ot.width),yt=Math.floor(dt*ot.height);u===void 0&&(u=g(_t,yt));let nt=E?g(_t,yt):u;return nt.width=_t,nt.height=yt,nt.getContext("2d").drawImage(I,0,0,_t,yt),jt("WebGLRenderer: Texture has been resized from ("+ot.width+"x"+ot.height+") to ("+_t+"x"+yt+")."),nt}else return"data"in I&&jt("WebGLRenderer: Image in DataTexture is too big ("+ot.width+"x"+ot.height+")."),I;return I}function T(I){return I.generateMipmaps}function v(I){i.generateMipmap(I)}function M(I){return I.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:I.isWebGL3DRenderTarget?i.TEXTURE_3D:I.isWebGLArrayRenderTarget||I.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function b(I,E,$,dt,ot,_t=!1){if(I!==null){if(i[I]!==void 0)return i[I];jt("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+I+"'")}let yt;dt&&(yt=t.get("EXT_texture_norm16"),yt||jt("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let nt=E;if(E===i.RED&&($===i.FLOAT&&(nt=i.R32F),$===i.HALF_FLOAT&&(nt=i.R16F),$===i.UNSIGNED_BYTE&&(nt=i.R8),$===i.UNSIGNED_SHORT&&yt&&(nt=yt.R16_EXT),$===i.SHORT&&yt&&(nt=yt.R16_SNORM_EXT)),E===i.RED_INTEGER&&($===i.UNSIGNED_BYTE&&(nt=i.R8UI),$===i.UNSIGNED_SHORT&&(nt=i.R16UI),$===i.UNSIGNED_INT&&(nt=i.R32UI),$===i.BYTE&&(nt=i.R8I),$===i.SHORT&&(nt=i.R16I),$===i.INT&&(nt=i.R32I)),E===i.RG&&($===i.FLOAT&&(nt=i.RG32F),$===i.HALF_FLOAT&&(nt=i.RG16F),$===i.UNSIGNED_BYTE&&(nt=i.RG8),$===i.UNSIGNED_SHORT&&yt&&(nt=yt.RG16_EXT),$===i.SHORT&&yt&&(nt=yt.RG16_SNORM_EXT)),E===i.RG_INTEGER&&($===i.UNSIGNED_BYTE&&(nt=i.RG8UI),$===i.UNSIGNED_SHORT&&(nt=i.RG16UI),$===i.UNSIGNED_INT&&(nt=i.RG32UI),$===i.BYTE&&(nt=i.RG8I),$===i.SHORT&&(nt=i.RG16I),$===i.INT&&(nt=i.RG32I)),E===i.RGB_INTEGER&&($===i.UNSIGNED_BYTE&&(nt=i.RGB8UI),$===i.UNSIGNED_SHORT&&(nt=i.RGB16UI),$===i.UNSIGNED_INT&&(nt=i.RGB32UI),$===i.BYTE&&(nt=i.RGB8I),$===i.SHORT&&(nt=i.RGB16I),$===i.INT&&(nt=i.RGB32I)),E===i.RGBA_INTEGER&&($===i.UNSIGNED_BYTE&&(nt=i.RGBA8UI),$===i.UNSIGNED_SHORT&&(nt=i.RGBA16UI),$===i.UNSIGNED_INT&&(nt=i.RGBA32UI),$===i.BYTE&&(nt=i.RGBA8I),$===i.SHORT&&(nt=i.RGBA16I),$===i.INT&&(nt=i.RGBA32I)),E===i.RGB&&($===i.UNSIGNED_SHORT&&yt&&(nt=yt.RGB16_EXT),$===i.SHORT&&yt&&(nt=yt.RGB16_SNORM_EXT),$===i.UNSIGNED_INT_5_9_9_9_REV&&(nt=i.RGB9_E5),$===i.UNSIGNED_INT_10F_11F_11F_REV&&(nt=i.R11F_G11F_B10F)),E===i.RGBA){let st=_t?La:Se.getTransfer(ot);$===i.FLOAT&&(nt=i.RGBA32F),$===i.HALF_FLOAT&&(nt=i.RGBA16F),$===i.UNSIGNED_BYTE&&(nt=st===Ie?i.SRGB8_ALPHA8:i.RGBA8),$===i.UNSIGNED_SHORT&&yt&&(nt=yt.RGBA16_EXT),$===i.SHORT&&yt&&(nt=yt.RGBA16_SNORM_EXT),$===i.UNSIGNED_SHORT_4_4_4_4&&(nt=i.RGBA4),$===i.UNSIGNED_SHORT_5_5_5_1&&(nt=i.RGB5_A1)}return(nt===i.R16F||nt===i.R32F||nt===i.RG16F||nt===i.RG32F||nt===i.RGBA16F||nt===i.RGBA32F)&&t.get("EXT_color_buffer_float"),nt}function x(I,E){let $;return I?E===null||E===Zi||E===Or?$=i.DEPTH24_STENCIL8:E===Fi?$=i.DEPTH32F_STENCIL8:E===Wo&&($=i.DEPTH24_STENCIL8,jt("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):E===null||E===Zi||E===Or?$=i.DEPTH_COMPONENT24:E===Fi?$=i.DEPTH_COMPONENT32F:E===Wo&&($=i.DEPTH_COMPONENT16),$}function w(I,E){return T(I)===!0||I.isFramebufferTexture&&I.minFilter!==zn&&I.minFilter!==ci?Math.log2(Math.max(E.width,E.height))+1:I.mipmaps.length>0?I.mipmaps.length:I.isCompressedTexture&&Array.isArray(I.image)?E.mipmaps.length:1}function O(I){let E=new WeakRef(I);n.get(I).__ref=E,p.add(E),_.register(I,E,E)}function P(I){let E=n.get(I).__ref;E!==void 0&&(p.delete(E),_.unregister(E))}function L(I){G(I.target)}function B(I){D(I.target)}function G(I){I.removeEventListener("dispose",L),P(I),Z(I),I.isVideoTexture&&d.delete(I),I.isHTMLTexture&&h.delete(I)}function D(I){I.removeEventListener("dispose",B),P(I),at(I)}function X(){for(let I of p){let E=I.deref();E!==void 0&&(E.isRenderTarget===!0?D(E):G(E))}p.clear(),h.clear()}function Z(I){let E=n.get(I);if(E.__webglInit===void 0)return;let $=I.source,dt=f.get($);if(dt){let ot=dt[E.__cacheKey];ot.usedTimes--,ot.usedTimes===0&&W(I),Object.keys(dt).length===0&&f.delete($)}n.remove(I)}function W(I){let E=n.get(I);i.deleteTexture(E.__webglTexture);let $=I.source,dt=f.get($);delete dt[E.__cacheKey],o.memory.textures--}function at(I){let E=n.get(I);E.__depthDisposeCallback&&E.__depthDisposeCallback();let $=I.depthTexture;if($&&$.renderTarget===I&&G($),I.isWebGLCubeRenderTarget)for(let ot=0;ot<6;ot++){if(Array.isArray(E.__webglFramebuffer[ot]))for(let _t=0;_t<E.__webglFramebuffer[ot].length;_t++)i.deleteFramebuffer(E.__webglFramebuffer[ot][_t]);else i.deleteFramebuffer(E.__webglFramebuffer[ot]);E.__webglDepthbuffer&&i.deleteRenderbuffer(E.__webglDepthbuffer[ot])}else{if(Array.isArray(E.__webglFramebuffer))for(let ot=0;ot<E.__webglFramebuffer.length;ot++)i.deleteFramebuffer(E.__webglFramebuffer[ot]);else i.deleteFramebuffer(E.__webglFramebuffer);if(E.__webglDepthbuffer&&i.deleteRenderbuffer(E.__webglDepthbuffer),E.__webglMultisampledFramebuffer&&i.deleteFramebuffer(E.__webglMultisampledFramebuffer),E.__webglColorRenderbuffer)for(let ot=0;ot<E.__webglColorRenderbuffer.length;ot++)E.__webglColorRenderbuffer[ot]&&i.deleteRenderbuffer(E.__webglColorRenderbuffer[ot]);E.__webglDepthRenderbuffer&&i.deleteRenderbuffer(E.__webglDepthRenderbuffer)}let dt=I.textures;for(let ot=0,_t=dt.length;ot<_t;ot++){let yt=n.get(dt[ot]);yt.__webglTexture&&(i.deleteTexture(yt.__webglTexture),o.memory.textures--),n.remove(dt[ot])}n.remove(I)}let k=0;function q(){k=0}function Q(){return k}function lt(I){k=I}function ht(){let I=k;return I>=s.maxTextures&&jt("WebGLTextures: Trying to use "+(I+1)+" texture units while this GPU supports only "+s.maxTextures),k+=1,I}function et(I){let E=[];return E.push(I.wrapS),E.push(I.wrapT),E.push(I.wrapR||0),E.push(I.magFilter),E.push(I.minFilter),E.push(I.anisotropy),E.push(I.internalFormat),E.push(I.format),E.push(I.type),E.push(I.generateMipmaps),E.push(I.mipmapsAutoUpdate),E.push(I.premultiplyAlpha),E.push(I.flipY),E.push(I.unpackAlignment),E.push(I.colorSpace),E.join()}function mt(I,E){let $=n.get(I);if(I.isVideoTexture&&Ve(I),I.isRenderTargetTexture===!1&&I.isExternalTexture!==!0&&I.version>0&&$.__version!==I.version){let dt=I.image;if(dt===null)jt("WebGLRenderer: Texture marked for update but no image data found.");else if(dt.complete===!1)jt("WebGLRenderer: Texture marked for update but image is incomplete");else{Xe($,I,E);return}}else I.isExternalTexture&&($.__webglTexture=I.sourceTexture?I.sourceTexture:null);e.bindTexture(i.TEXTURE_2D,$.__webglTexture,i.TEXTURE0+E)}function xt(I,E){let $=n.get(I);if(I.isRenderTargetTexture===!1&&I.version>0&&$.__version!==I.version){Xe($,I,E);return}else I.isExternalTexture&&($.__webglTexture=I.sourceTexture?I.sourceTexture:null);e.bindTexture(i.TEXTURE_2D_ARRAY,$.__webglTexture,i.TEXTURE0+E)}function Ct(I,E){let $=n.get(I);if(I.isRenderTargetTexture===!1&&I.version>0&&$.__version!==I.version){Xe($,I,E);return}e.bindTexture(i.TEXTURE_3D,$.__webglTexture,i.TEXTURE0+E)}function wt(I,E){let $=n.get(I);if(I.version>0&&$.__version!==I.version){mn($,I,E);return}e.bindTexture(i.TEXTURE_CUBE_MAP,$.__webglTexture,i.TEXTURE0+E)}let $t={[Co]:i.REPEAT,[hs]:i.CLAMP_TO_EDGE,[bc]:i.MIRRORED_REPEAT},le={[zn]:i.NEAREST,[ig]:i.NEAREST_MIPMAP_NEAREST,[ol]:i.NEAREST_MIPMAP_LINEAR,[ci]:i.LINEAR,[Jc]:i.LINEAR_MIPMAP_NEAREST,[ks]:i.LINEAR_MIPMAP_LINEAR},Yt={[ag]:i.NEVER,[jd]:i.ALWAYS,[lg]:i.LESS,[Zd]:i.LEQUAL,[cg]:i.EQUAL,[Jd]:i.GEQUAL,[hg]:i.GREATER,[ug]:i.NOTEQUAL};function ge(I,E){if(E.type===Fi&&t.has("OES_texture_float_linear")===!1&&(E.magFilter===ci||E.magFilter===Jc||E.magFilter===ol||E.magFilter===ks||E.minFilter===ci||E.minFilter===Jc||E.minFilter===ol||E.minFilter===ks)&&jt("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(I,i.TEXTURE_WRAP_S,$t[E.wrapS]),i.texParameteri(I,i.TEXTURE_WRAP_T,$t[E.wrapT]),(I===i.TEXTURE_3D||I===i.TEXTURE_2D_ARRAY)&&i.texParameteri(I,i.TEXTURE_WRAP_R,$t[E.wrapR]),i.texParameteri(I,i.TEXTURE_MAG_FILTER,le[E.magFilter]),i.texParameteri(I,i.TEXTURE_MIN_FILTER,le[E.minFilter]),E.compareFunction&&(i.texParameteri(I,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(I,i.TEXTURE_COMPARE_FUNC,Yt[E.compareFunction])),t.has("EXT_texture_filter_anisotropic")===!0){if(E.magFilter===zn||E.minFilter!==ol&&E.minFilter!==ks||E.type===Fi&&t.has("OES_texture_float_linear")===!1)return;if(E.anisotropy>1||n.get(E).__currentAnisotropy){let $=t.get("EXT_texture_filter_anisotropic");i.texParameterf(I,$.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(E.anisotropy,s.getMaxAnisotropy())),n.get(E).__currentAnisotropy=E.anisotropy}}}function de(I,E){let $=!1;I.__webglInit===void 0&&(I.__webglInit=!0,E.addEventListener("dispose",L),O(E));let dt=E.source,ot=f.get(dt);ot===void 0&&(ot={},f.set(dt,ot));let _t=et(E);if(_t!==I.__cacheKey){ot[_t]===void 0&&(ot[_t]={texture:i.createTexture(),usedTimes:0},o.memory.textures++,$=!0),ot[_t].usedTimes++;let yt=ot[I.__cacheKey];yt!==void 0&&(ot[I.__cacheKey].usedTimes--,yt.usedTimes===0&&W(E)),I.__cacheKey=_t,I.__webglTexture=ot[_t].texture}return $}function oe(I,E,$){return Math.floor(Math.floor(I/$)/E)}function Qe(I,E,$,dt){let _t=I.updateRanges;if(_t.length===0)e.texSubImage2D(i.TEXTURE_2D,0,0,0,E.width,E.height,$,dt,E.data);else{_t.sort((z,rt)=>z.start-rt.start);let yt=0;for(let z=1;z<_t.length;z++){let rt=_t[yt],it=_t[z],Tt=rt.start+rt.count,gt=oe(it.start,E.width,4),Mt=oe(rt.start,E.width,4);it.start<=Tt+1&&gt===Mt&&oe(it.start+it.count-1,E.width,4)===gt?rt.count=Math.max(rt.count,it.start+it.count-rt.start):(++yt,_t[yt]=it)}_t.length=yt+1;let nt=e.getParameter(i.UNPACK_ROW_LENGTH),st=e.getParameter(i.UNPACK_SKIP_PIXELS),pt=e.getParameter(i.UNPACK_SKIP_ROWS);e.pixelStorei(i.UNPACK_ROW_LENGTH,E.width);for(let z=0,rt=_t.length;z<rt;z++){let it=_t[z],Tt=Math.floor(it.start/4),gt=Math.ceil(it.count/4),Mt=Tt%E.width,qt=Math.floor(Tt/E.width),ee=gt,ut=1;e.pixelStorei(i.UNPACK_SKIP_PIXELS,Mt),e.pixelStorei(i.UNPACK_SKIP_ROWS,qt),e.texSubImage2D(i.TEXTURE_2D,0,Mt,qt,ee,ut,$,dt,E.data)}I.clearUpdateRanges(),e.pixelStorei(i.UNPACK_ROW_LENGTH,nt),e.pixelStorei(i.UNPACK_SKIP_PIXELS,st),e.pixelStorei(i.UNPACK_SKIP_ROWS,pt)}}function Xe(I,E,$){let dt=i.TEXTURE_2D;(E.isDataArrayTexture||E.isCompressedArrayTexture)&&(dt=i.TEXTURE_2D_ARRAY),E.isData3DTexture&&(dt=i.TEXTURE_3D);let ot=de(I,E),_t=E.source;e.bindTexture(dt,I.__webglTexture,i.TEXTURE0+$);let yt=n.get(_t);if(_t.version!==yt.__version||ot===!0){if(e.activeTexture(i.TEXTURE0+$),(typeof ImageBitmap<"u"&&E.image instanceof ImageBitmap)===!1){let ut=Se.getPrimaries(Se.workingColorSpace),zt=E.colorSpace===Vs?null:Se.getPrimaries(E.colorSpace),ne=E.colorSpace===Vs||ut===zt?i.NONE:i.BROWSER_DEFAULT_WEBGL;e.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,E.flipY),e.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,E.premultiplyAlpha),e.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,ne)}e.pixelStorei(i.UNPACK_ALIGNMENT,E.unpackAlignment);let st=y(E.image,!1,s.maxTextureSize);st=Ht(E,st);let pt=r.convert(E.format,E.colorSpace),z=r.convert(E.type),rt=b(E.internalFormat,pt,z,E.normalized,E.colorSpace,E.isVideoTexture);ge(dt,E);let it,Tt=E.mipmaps,gt=E.isVideoTexture!==!0,Mt=yt.__version===void 0||ot===!0,qt=_t.dataReady,ee=w(E,st);if(E.isDepthTexture)rt=x(E.format===zs,E.type),Mt&&(gt?e.texStorage2D(i.TEXTURE_2D,1,rt,st.width,st.height):e.texImage2D(i.TEXTURE_2D,0,rt,st.width,st.height,0,pt,z,null));else if(E.isDataTexture)if(Tt.length>0){gt&&Mt&&e.texStorage2D(i.TEXTURE_2D,ee,rt,Tt[0].width,Tt[0].height);for(let ut=0,zt=Tt.length;ut<zt;ut++)it=Tt[ut],gt?qt&&e.texSubImage2D(i.TEXTURE_2D,ut,0,0,it.width,it.height,pt,z,it.data):e.texImage2D(i.TEXTURE_2D,ut,rt,it.width,it.height,0,pt,z,it.data);E.generateMipmaps=!1}else gt?(Mt&&e.texStorage2D(i.TEXTURE_2D,ee,rt,st.width,st.height),qt&&Qe(E,st,pt,z)):e.texImage2D(i.TEXTURE_2D,0,rt,st.width,st.height,0,pt,z,st.data);else if(E.isCompressedTexture)if(E.isCompressedArrayTexture){gt&&Mt&&e.texStorage3D(i.TEXTURE_2D_ARRAY,ee,rt,Tt[0].width,Tt[0].height,st.depth);for(let ut=0,zt=Tt.length;ut<zt;ut++)if(it=Tt[ut],E.format!==ji)if(pt!==null)if(gt){if(qt)if(E.layerUpdates.size>0){let ne=lf(it.width,it.height,E.format,E.type);for(let Rt of E.layerUpdates){let ue=it.data.subarray(Rt*ne/it.data.BYTES_PER_ELEMENT,(Rt+1)*ne/it.data.BYTES_PER_ELEMENT);e.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,ut,0,0,Rt,it.width,it.height,1,pt,ue)}}else e.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,ut,0,0,0,it.width,it.height,st.depth,pt,it.data)}else e.compressedTexImage3D(i.TEXTURE_2D_ARRAY,ut,rt,it.width,it.height,st.depth,0,it.data,0,0);else jt("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else gt?qt&&e.texSubImage3D(i.TEXTURE_2D_ARRAY,ut,0,0,0,it.width,it.height,st.depth,pt,z,it.data):e.texImage3D(i.TEXTURE_2D_ARRAY,ut,rt,it.width,it.height,st.depth,0,pt,z,it.data);E.layerUpdates.size>0&&E.clearLayerUpdates()}else{gt&&Mt&&e.texStorage2D(i.TEXTURE_2D,ee,rt,Tt[0].width,Tt[0].height);for(let ut=0,zt=Tt.length;ut<zt;ut++)it=Tt[ut],E.format!==ji?pt!==null?gt?qt&&e.compressedTexSubImage2D(i.TEXTURE_2D,ut,0,0,it.width,it.height,pt,it.data):e.compressedTexImage2D(i.TEXTURE_2D,ut,rt,it.width,it.height,0,it.data):jt("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):gt?qt&&e.texSubImage2D(i.TEXTURE_2D,ut,0,0,it.width,it.height,pt,z,it.data):e.texImage2D(i.TEXTURE_2D,ut,rt,it.width,it.height,0,pt,z,it.data)}else if(E.isDataArrayTexture)if(gt){if(Mt&&e.texStorage3D(i.TEXTURE_2D_ARRAY,ee,rt,st.width,st.height,st.depth),qt)if(E.layerUpdates.size>0){let ut=lf(st.width,st.height,E.format,E.type);for(let zt of E.layerUpdates){let ne=st.data.subarray(zt*ut/st.data.BYTES_PER_ELEMENT,(zt+1)*ut/st.data.BYTES_PER_ELEMENT);e.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,zt,st.width,st.height,1,pt,z,ne)}E.clearLayerUpdates()}else e.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,st.width,st.height,st.depth,pt,z,st.data)}else e.texImage3D(i.TEXTURE_2D_ARRAY,0,rt,st.width,st.height,st.depth,0,pt,z,st.data);else if(E.isData3DTexture)gt?(Mt&&e.texStorage3D(i.TEXTURE_3D,ee,rt,st.width,st.height,st.depth),qt&&e.texSubImage3D(i.TEXTURE_3D,0,0,0,0,st.width,st.height,st.depth,pt,z,st.data)):e.texImage3D(i.TEXTURE_3D,0,rt,st.width,st.height,st.depth,0,pt,z,st.data);else if(E.isFramebufferTexture){if(Mt)if(gt)e.texStorage2D(i.TEXTURE_2D,ee,rt,st.width,st.height);else{let ut=st.width,zt=st.height;for(let ne=0;ne<ee;ne++)e.texImage2D(i.TEXTURE_2D,ne,rt,ut,zt,0,pt,z,null),ut>>=1,zt>>=1}}else if(E.isHTMLTexture){if("texElementImage2D"in i){let ut=i.canvas;if(ut.hasAttribute("layoutsubtree")||ut.setAttribute("layoutsubtree","true"),st.parentNode!==ut){ut.appendChild(st),h.add(E),ut.onpaint=zt=>{let ne=zt.changedElements;for(let Rt of h)ne.includes(Rt.image)&&(Rt.needsUpdate=!0)},ut.requestPaint();return}if(i.texElementImage2D.length===3)i.texElementImage2D(i.TEXTURE_2D,i.RGBA8,st);else{let ne=i.RGBA,Rt=i.RGBA,ue=i.UNSIGNED_BYTE;i.texElementImage2D(i.TEXTURE_2D,0,ne,Rt,ue,st)}i.texParameteri(i.TEXTURE_2D,i.TEXTURE_MIN_FILTER,i.LINEAR),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_S,i.CLAMP_TO_EDGE),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_T,i.CLAMP_TO_EDGE)}}else if(Tt.length>0){if(gt&&Mt){let ut=Jt(Tt[0]);e.texStorage2D(i.TEXTURE_2D,ee,rt,ut.width,ut.height)}for(let ut=0,zt=Tt.length;ut<zt;ut++)it=Tt[ut],gt?qt&&e.texSubImage2D(i.TEXTURE_2D,ut,0,0,pt,z,it):e.texImage2D(i.TEXTURE_2D,ut,rt,pt,z,it);E.generateMipmaps=!1}else if(gt){if(Mt){let ut=Jt(st);e.texStorage2D(i.TEXTURE_2D,ee,rt,ut.width,ut.height)}qt&&e.texSubImage2D(i.TEXTURE_2D,0,0,0,pt,z,st)}else e.texImage2D(i.TEXTURE_2D,0,rt,pt,z,st);T(E)&&E.mipmapsAutoUpdate===!0&&v(dt),yt.__version=_t.version,E.onUpdate&&E.onUpdate(E)}I.__version=E.version}function mn(I,E,$){if(E.image.length!==6)return;let dt=de(I,E),ot=E.source;e.bindTexture(i.TEXTURE_CUBE_MAP,I.__webglTexture,i.TEXTURE0+$);let _t=n.get(ot);if(ot.version!==_t.__version||dt===!0){e.activeTexture(i.TEXTURE0+$);let yt=Se.getPrimaries(Se.workingColorSpace),nt=E.colorSpace===Vs?null:Se.getPrimaries(E.colorSpace),st=E.colorSpace===Vs||yt===nt?i.NONE:i.BROWSER_DEFAULT_WEBGL;e.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,E.flipY),e.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,E.premultiplyAlpha),e.pixelStorei(i.UNPACK_ALIGNMENT,E.unpackAlignment),e.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,st);let pt=E.isCompressedTexture||E.image[0].isCompressedTexture,z=E.image[0]&&E.image[0].isDataTexture,rt=[];for(let Rt=0;Rt<6;Rt++)!pt&&!z?rt[Rt]=y(E.image[Rt],!0,s.maxCubemapSize):rt[Rt]=z?E.image[Rt].image:E.image[Rt],rt[Rt]=Ht(E,rt[Rt]);let it=rt[0],Tt=r.convert(E.format,E.colorSpace),gt=r.convert(E.type),Mt=b(E.internalFormat,Tt,gt,E.normalized,E.colorSpace),qt=E.isVideoTexture!==!0,ee=_t.__version===void 0||dt===!0,ut=ot.dataReady,zt=w(E,it);ge(i.TEXTURE_CUBE_MAP,E);let ne;if(E.isDepthTexture){if(Mt=x(E.format===zs,E.type),ee)if(qt)e.texStorage2D(i.TEXTURE_CUBE_MAP,1,Mt,it.width,it.height);else for(let Rt=0;Rt<6;Rt++)e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,0,Mt,it.width,it.height,0,Tt,gt,null)}else if(pt){qt&&ee&&e.texStorage2D(i.TEXTURE_CUBE_MAP,zt,Mt,it.width,it.height);for(let Rt=0;Rt<6;Rt++){ne=rt[Rt].mipmaps;for(let ue=0;ue<ne.length;ue++){let qe=ne[ue];E.format!==ji?Tt!==null?qt?ut&&e.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,ue,0,0,qe.width,qe.height,Tt,qe.data):e.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,ue,Mt,qe.width,qe.height,0,qe.data):jt("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):qt?ut&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,ue,0,0,qe.width,qe.height,Tt,gt,qe.data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,ue,Mt,qe.width,qe.height,0,Tt,gt,qe.data)}}}else{if(ne=E.mipmaps,qt&&ee){ne.length>0&&zt++;let Rt=Jt(rt[0]);e.texStorage2D(i.TEXTURE_CUBE_MAP,zt,Mt,Rt.width,Rt.height)}for(let Rt=0;Rt<6;Rt++)if(z){qt?ut&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,0,0,0,rt[Rt].width,rt[Rt].height,Tt,gt,rt[Rt].data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,0,Mt,rt[Rt].width,rt[Rt].height,0,Tt,gt,rt[Rt].data);for(let ue=0;ue<ne.length;ue++){let ii=ne[ue].image[Rt].image;qt?ut&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,ue+1,0,0,ii.width,ii.height,Tt,gt,ii.data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,ue+1,Mt,ii.width,ii.height,0,Tt,gt,ii.data)}}else{qt?ut&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,0,0,0,Tt,gt,rt[Rt]):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,0,Mt,Tt,gt,rt[Rt]);for(let ue=0;ue<ne.length;ue++){let qe=ne[ue];qt?ut&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,ue+1,0,0,Tt,gt,qe.image[Rt]):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Rt,ue+1,Mt,Tt,gt,qe.image[Rt])}}}T(E)&&E.mipmapsAutoUpdate===!0&&v(i.TEXTURE_CUBE_MAP),_t.__version=ot.version,E.onUpdate&&E.onUpdate(E)}I.__version=E.version}function Be(I,E,$,dt,ot,_t){let yt=r.convert($.format,$.colorSpace),nt=r.convert($.type),st=b($.internalFormat,yt,nt,$.normalized,$.colorSpace),pt=n.get(E),z=n.get($);if(z.__renderTarget=E,!pt.__hasExternalTextures){let rt=Math.max(1,E.width>>_t),it=Math.max(1,E.height>>_t);ot===i.TEXTURE_3D||ot===i.TEXTURE_2D_ARRAY?e.texImage3D(ot,_t,st,rt,it,E.depth,0,yt,nt,null):e.texImage2D(ot,_t,st,rt,it,0,yt,nt,null)}e.bindFramebuffer(i.FRAMEBUFFER,I),bt(E)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,dt,ot,z.__webglTexture,0,ce(E)):(ot===i.TEXTURE_2D||ot>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&ot<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,dt,ot,z.__webglTexture,_t),e.bindFramebuffer(i.FRAMEBUFFER,null)}function Nn(I,E,$){if(i.bindRenderbuffer(i.RENDERBUFFER,I),E.depthBuffer){let dt=E.depthTexture,ot=dt&&dt.isDepthTexture?dt.type:null,_t=x(E.stencilBuffer,ot),yt=E.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;bt(E)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,ce(E),_t,E.width,E.height):$?i.renderbufferStorageMultisample(i.RENDERBUFFER,ce(E),_t,E.width,E.height):i.renderbufferStorage(i.RENDERBUFFER,_t,E.width,E.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,yt,i.RENDERBUFFER,I)}else{let dt=E.textures;for(let ot=0;ot<dt.length;ot++){let _t=dt[ot],yt=r.convert(_t.format,_t.colorSpace),nt=r.convert(_t.type),st=b(_t.internalFormat,yt,nt,_t.normalized,_t.colorSpace);bt(E)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,ce(E),st,E.width,E.height):$?i.renderbufferStorageMultisample(i.RENDERBUFFER,ce(E),st,E.width,E.height):i.renderbufferStorage(i.RENDERBUFFER,st,E.width,E.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function we(I,E,$){let dt=E.isWebGLCubeRenderTarget===!0;if(e.bindFramebuffer(i.FRAMEBUFFER,I),!(E.depthTexture&&E.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let ot=n.get(E.depthTexture);ot.__renderTarget=E;let _t=dt?E.depthTexture.image[0]:E.depthTexture.image;(!ot.__webglTexture||_t.width!==E.width||_t.height!==E.height)&&(_t.width=E.width,_t.height=E.height,E.depthTexture.needsUpdate=!0),dt?wt(E.depthTexture,0):mt(E.depthTexture,0);let yt=ot.__webglTexture,nt=ce(E),st=dt?i.TEXTURE_CUBE_MAP_POSITIVE_X+$:i.TEXTURE_2D,pt=E.depthTexture.format===zs?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;if(E.depthTexture.format===Ds)bt(E)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,pt,st,yt,0,nt):i.framebufferTexture2D(i.FRAMEBUFFER,pt,st,yt,0);else if(E.depthTexture.format===zs)bt(E)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,pt,st,yt,0,nt):i.framebufferTexture2D(i.FRAMEBUFFER,pt,st,yt,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function bn(I){let E=n.get(I),$=I.isWebGLCubeRenderTarget===!0;if(E.__boundDepthTexture!==I.depthTexture){let dt=I.depthTexture;if(E.__depthDisposeCallback&&E.__depthDisposeCallback(),dt){let ot=()=>{delete E.__boundDepthTexture,delete E.__depthDisposeCallback,dt.removeEventListener("dispose",ot)};dt.addEventListener("dispose",ot),E.__depthDisposeCallback=ot}E.__boundDepthTexture=dt}if(I.depthTexture&&!E.__autoAllocateDepthBuffer)if($)for(let dt=0;dt<6;dt++)we(E.__webglFramebuffer[dt],I,dt);else I.texture.mipmaps.length>0?we(E.__webglFramebuffer[0],I,0):we(E.__webglFramebuffer,I,0);else if($){E.__webglDepthbuffer=[];for(let dt=0;dt<6;dt++)if(e.bindFramebuffer(i.FRAMEBUFFER,E.__webglFramebuffer[dt]),E.__webglDepthbuffer[dt]===void 0)E.__webglDepthbuffer[dt]=i.createRenderbuffer(),Nn(E.__webglDepthbuffer[dt],I,!1);else{let ot=I.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,_t=E.__webglDepthbuffer[dt];i.bindRenderbuffer(i.RENDERBUFFER,_t),i.framebufferRenderbuffer(i.FRAMEBUFFER,ot,i.RENDERBUFFER,_t)}}else if(I.texture.mipmaps.length>0?e.bindFramebuffer(i.FRAMEBUFFER,E.__webglFramebuffer[0]):e.bindFramebuffer(i.FRAMEBUFFER,E.__webglFramebuffer),E.__webglDepthbuffer===void 0)E.__webglDepthbuffer=i.createRenderbuffer(),Nn(E.__webglDepthbuffer,I,!1);else{let ot=I.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,_t=E.__webglDepthbuffer;i.bindRenderbuffer(i.RENDERBUFFER,_t),i.framebufferRenderbuffer(i.FRAMEBUFFER,ot,i.RENDERBUFFER,_t)}e.bindFramebuffer(i.FRAMEBUFFER,null)}function an(I,E,$){let dt=n.get(I);E!==void 0&&Be(dt.__webglFramebuffer,I,I.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),$!==void 0&&bn(I)}function gn(I){let E=I.texture,$=n.get(I),dt=n.get(E);I.addEventListener("dispose",B),O(I);let ot=I.textures,_t=I.isWebGLCubeRenderTarget===!0,yt=ot.length>1;if(yt||(dt.__webglTexture===void 0&&(dt.__webglTexture=i.createTexture()),dt.__version=E.version,o.memory.textures++),_t){$.__webglFramebuffer=[];for(let nt=0;nt<6;nt++)if(E.mipmaps.length>0){$.__webglFramebuffer[nt]=[];for(let st=0;st<E.mipmaps.length;st++)$.__webglFramebuffer[nt][st]=i.createFramebuffer()}else $.__webglFramebuffer[nt]=i.createFramebuffer()}else{if(E.mipmaps.length>0){$.__webglFramebuffer=[];for(let nt=0;nt<E.mipmaps.length;nt++)$.__webglFramebuffer[nt]=i.createFramebuffer()}else $.__webglFramebuffer=i.createFramebuffer();if(yt)for(let nt=0,st=ot.length;nt<st;nt++){let pt=n.get(ot[nt]);pt.__webglTexture===void 0&&(pt.__webglTexture=i.createTexture(),o.memory.textures++)}if(I.samples>0&&bt(I)===!1){$.__webglMultisampledFramebuffer=i.createFramebuffer(),$.__webglColorRenderbuffer=[],e.bindFramebuffer(i.FRAMEBUFFER,$.__webglMultisampledFramebuffer);for(let nt=0;nt<ot.length;nt++){let st=ot[nt];$.__webglColorRenderbuffer[nt]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,$.__webglColorRenderbuffer[nt]);let pt=r.convert(st.format,st.colorSpace),z=r.convert(st.type),rt=b(st.internalFormat,pt,z,st.normalized,st.colorSpace,I.isXRRenderTarget===!0),it=ce(I);i.renderbufferStorageMultisample(i.RENDERBUFFER,it,rt,I.width,I.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+nt,i.RENDERBUFFER,$.__webglColorRenderbuffer[nt])}i.bindRenderbuffer(i.RENDERBUFFER,null),I.depthBuffer&&($.__webglDepthRenderbuffer=i.createRenderbuffer(),Nn($.__webglDepthRenderbuffer,I,!0)),e.bindFramebuffer(i.FRAMEBUFFER,null)}}if(_t){e.bindTexture(i.TEXTURE_CUBE_MAP,dt.__webglTexture),ge(i.TEXTURE_CUBE_MAP,E);for(let nt=0;nt<6;nt++)if(E.mipmaps.length>0)for(let st=0;st<E.mipmaps.length;st++)Be($.__webglFramebuffer[nt][st],I,E,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+nt,st);else Be($.__webglFramebuffer[nt],I,E,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+nt,0);T(E)?v(i.TEXTURE_CUBE_MAP):E.mipmaps.length>0&&i.texParameteri(i.TEXTURE_CUBE_MAP,i.TEXTURE_MAX_LEVEL,E.mipmaps.length-1),e.unbindTexture()}else if(yt){for(let nt=0,st=ot.length;nt<st;nt++){let pt=ot[nt],z=n.get(pt),rt=i.TEXTURE_2D;(I.isWebGL3DRenderTarget||I.isWebGLArrayRenderTarget)&&(rt=I.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),e.bindTexture(rt,z.__webglTexture),ge(rt,pt),Be($.__webglFramebuffer,I,pt,i.COLOR_ATTACHMENT0+nt,rt,0),T(pt)&&v(rt)}e.unbindTexture()}else{let nt=i.TEXTURE_2D;if((I.isWebGL3DRenderTarget||I.isWebGLArrayRenderTarget)&&(nt=I.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),e.bindTexture(nt,dt.__webglTexture),ge(nt,E),E.mipmaps.length>0)for(let st=0;st<E.mipmaps.length;st++)Be($.__webglFramebuffer[st],I,E,i.COLOR_ATTACHMENT0,nt,st);else Be($.__webglFramebuffer,I,E,i.COLOR_ATTACHMENT0,nt,0);T(E)?v(nt):E.mipmaps.length>0&&i.texParameteri(nt,i.TEXTURE_MAX_LEVEL,E.mipmaps.length-1),e.unbindTexture()}I.depthBuffer&&bn(I)}function V(I){let E=I.textures;for(let $=0,dt=E.length;$<dt;$++){let ot=E[$];if(T(ot)&&ot.mipmapsAutoUpdate===!0){let _t=M(I),yt=n.get(ot).__webglTexture;e.bindTexture(_t,yt),v(_t),e.unbindTexture()}}}let Pt=[];function Kt(I){if(I.samples>0){if(bt(I)===!1){let E=I.textures,$=I.width,dt=I.height,ot=i.COLOR_BUFFER_BIT,_t=I.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,yt=n.get(I),nt=E.length>1;if(nt)for(let pt=0;pt<E.length;pt++)e.bindFramebuffer(i.FRAMEBUFFER,yt.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+pt,i.RENDERBUFFER,null),e.bindFramebuffer(i.FRAMEBUFFER,yt.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+pt,i.TEXTURE_2D,null,0);e.bindFramebuffer(i.READ_FRAMEBUFFER,yt.__webglMultisampledFramebuffer),I.texture.mipmaps.length>0?e.bindFramebuffer(i.DRAW_FRAMEBUFFER,yt.__webglFramebuffer[0]):e.bindFramebuffer(i.DRAW_FRAMEBUFFER,yt.__webglFramebuffer);for(let pt=0;pt<E.length;pt++){if(I.resolveDepthBuffer&&(I.depthBuffer&&(ot|=i.DEPTH_BUFFER_BIT),I.stencilBuffer&&I.resolveStencilBuffer&&(ot|=i.STENCIL_BUFFER_BIT)),nt){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,yt.__webglColorRenderbuffer[pt]);let z=n.get(E[pt]).__webglTexture;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,z,0)}i.blitFramebuffer(0,0,$,dt,0,0,$,dt,ot,i.NEAREST),l===!0&&(Pt.length=0,Pt.push(i.COLOR_ATTACHMENT0+pt),I.depthBuffer&&I.storeMultisampledDepthBuffer===!1&&Pt.push(_t),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,Pt))}if(e.bindFramebuffer(i.READ_FRAMEBUFFER,null),e.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),nt)for(let pt=0;pt<E.length;pt++){e.bindFramebuffer(i.FRAMEBUFFER,yt.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+pt,i.RENDERBUFFER,yt.__webglColorRenderbuffer[pt]);let z=n.get(E[pt]).__webglTexture;e.bindFramebuffer(i.FRAMEBUFFER,yt.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+pt,i.TEXTURE_2D,z,0)}e.bindFramebuffer(i.DRAW_FRAMEBUFFER,yt.__webglMultisampledFramebuffer)}else if(I.depthBuffer&&I.storeMultisampledDepthBuffer===!1&&l){let E=I.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[E])}}}function ce(I){return Math.min(s.maxSamples,I.samples)}function bt(I){let E=n.get(I);return I.samples>0&&t.has("WEBGL_multisampled_render_to_texture")===!0&&E.__useRenderToTexture!==!1}function Ve(I){let E=o.render.frame;d.get(I)!==E&&(d.set(I,E),I.update())}function Ht(I,E){let $=I.colorSpace,dt=I.format,ot=I.type;return I.isCompressedTexture===!0||I.isVideoTexture===!0||$!==Ia&&$!==Vs&&(Se.getTransfer($)===Ie?(dt!==ji||ot!==_i)&&jt("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):te("WebGLTextures: Unsupported texture color space:",$)),E}function Jt(I){return typeof HTMLImageElement<"u"&&I instanceof HTMLImageElement?(c.width=I.naturalWidth||I.width,c.height=I.naturalHeight||I.height):typeof VideoFrame<"u"&&I instanceof VideoFrame?(c.width=I.displayWidth,c.height=I.displayHeight):(c.width=I.width,c.height=I.height),c}this.allocateTextureUnit=ht,this.resetTextureUnits=q,this.getTextureUnits=Q,this.setTextureUnits=lt,this.setTexture2D=mt,this.setTexture2DArray=xt,this.setTexture3D=Ct,this.setTextureCube=wt,this.rebindTextures=an,this.setupRenderTarget=gn,this.updateRenderTargetMipmap=V,this.updateMultisampleRenderTarget=Kt,this.setupDepthRenderbuffer=bn,this.setupFrameBufferTexture=Be,this.useMultisampledRTT=bt,this.dispose=X}function Db(i,t){function e(n,s=Vs){let r,o=Se.getTransfer(s);if(n===_i)return i.UNSIGNED_BYTE;if(n===Kc)return i.UNSIGNED_SHORT_4_4_4_4;if(n===Qc)return i.UNSIGNED_SHORT_5_5_5_1;if(n===Xd)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===Yd)return i.UNSIGNED_INT_10F_11F_11F_REV;if(n===Hd)return i.BYTE;if(n===Wd)return i.SHORT;if(n===Wo)return i.UNSIGNED_SHORT;if(n===jc)return i.INT;if(n===Zi)return i.UNSIGNED_INT;if(n===Fi)return i.FLOAT;if(n===Ji)return i.HALF_FLOAT;if(n===qd)return i.ALPHA;if(n===$d)return i.RGB;if(n===ji)return i.RGBA;if(n===Ds)return i.DEPTH_COMPONENT;if(n===zs)return i.DEPTH_STENCIL;if(n===th)return i.RED;if(n===eh)return i.RED_INTEGER;if(n===fr)return i.RG;if(n===nh)return i.RG_INTEGER;if(n===ih)return i.RGBA_INTEGER;if(n===al||n===ll||n===cl||n===hl)if(o===Ie)if(r=t.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(n===al)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===ll)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===cl)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===hl)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=t.get("WEBGL_compressed_texture_s3tc"),r!==null){if(n===al)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===ll)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===cl)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===hl)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===sh||n===rh||n===oh||n===ah)if(r=t.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(n===sh)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===rh)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===oh)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===ah)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===lh||n===ch||n===hh||n===uh||n===dh||n===ul||n===fh)if(r=t.get("WEBGL_compressed_texture_etc"),r!==null){if(n===lh||n===ch)return o===Ie?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(n===hh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(n===uh)return r.COMPRESSED_R11_EAC;if(n===dh)return r.COMPRESSED_SIGNED_R11_EAC;if(n===ul)return r.COMPRESSED_RG11_EAC;if(n===fh)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(n===ph||n===mh||n===gh||n===_h||n===xh||n===yh||n===vh||n===Sh||n===Mh||n===wh||n===bh||n===Th||n===Eh||n===Ah)if(r=t.get("WEBGL_compressed_texture_astc"),r!==null){if(n===ph)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===mh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===gh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===_h)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===xh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===yh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===vh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===Sh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===Mh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===wh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===bh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===Th)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===Eh)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===Ah)return o===Ie?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===Ch||n===Rh||n===Ph)if(r=t.get("EXT_texture_compression_bptc"),r!==null){if(n===Ch)return o===Ie?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===Rh)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===Ph)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===Ih||n===Lh||n===dl||n===Dh)if(r=t.get("EXT_texture_compression_rgtc"),r!==null){if(n===Ih)return r.COMPRESSED_RED_RGTC1_EXT;if(n===Lh)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===dl)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===Dh)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===Or?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:e}}var Nb=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,Ob=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,_f=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(t,e){if(this.texture===null){let n=new Xa(t.texture);(t.depthNear!==e.depthNear||t.depthFar!==e.depthFar)&&(this.depthNear=t.depthNear,this.depthFar=t.depthFar),this.texture=n}}getMesh(t){if(this.texture!==null&&this.mesh===null){let e=t.cameras[0].viewport,n=new ui({vertexShader:Nb,fragmentShader:Ob,uniforms:{depthColor:{value:this.texture},depthWidth:{value:e.z},depthHeight:{value:e.w}}});this.mesh=new St(new gi(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},xf=class extends $i{constructor(t,e){super();let n=this,s=null,r=1,o=null,a="local-floor",l=1,c=null,d=null,h=null,u=null,f=null,p=null,_=typeof XRWebGLBinding<"u",m=new _f,g={},y=e.getContextAttributes(),T=null,v=null,M=[],b=[],x=new Bt,w=null,O=null,P=new An;P.viewport=new De;let L=new An;L.viewport=new De;let B=[P,L],G=new Yc,D=null,X=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(et){let mt=M[et];return mt===void 0&&(mt=new Do,M[et]=mt),mt.getTargetRaySpace()},this.getControllerGrip=function(et){let mt=M[et];return mt===void 0&&(mt=new Do,M[et]=mt),mt.getGripSpace()},this.getHand=function(et){let mt=M[et];return mt===void 0&&(mt=new Do,M[et]=mt),mt.getHandSpace()};function Z(et){let mt=b.indexOf(et.inputSource);if(mt===-1)return;let xt=M[mt];xt!==void 0&&(xt.update(et.inputSource,et.frame,c||o),xt.dispatchEvent({type:et.type,data:et.inputSource}))}function W(){s.removeEventListener("select",Z),s.removeEventListener("selectstart",Z),s.removeEventListener("selectend",Z),s.removeEventListener("squeeze",Z),s.removeEventListener("squeezestart",Z),s.removeEventListener("squeezeend",Z),s.removeEventListener("end",W),s.removeEventListener("inputsourceschange",at);for(let et=0;et<M.length;et++){let mt=b[et];mt!==null&&(b[et]=null,M[et].disconnect(mt))}D=null,X=null,m.reset();for(let et in g)delete g[et];if(t.setRenderTarget(T),f=null,u=null,h=null,s=null,v=null,ht.stop(),n.isPresenting=!1,t.setPixelRatio(w),t.setSize(x.width,x.height,!1),O!==null){let et=O.camera;et.fov=O.fov,et.zoom=O.zoom,et.updateProjectionMatrix(),O=null}n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(et){r=et,n.isPresenting===!0&&jt("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(et){a=et,n.isPresenting===!0&&jt("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||o},this.setReferenceSpace=function(et){c=et},this.getBaseLayer=function(){return u!==null?u:f},this.getBinding=function(){return h===null&&_&&(h=new XRWebGLBinding(s,e)),h},this.getFrame=function(){return p},this.getSession=function(){return s},this.setSession=async function(et){if(s=et,s!==null){if(T=t.getRenderTarget(),s.addEventListener("select",Z),s.addEventListener("selectstart",Z),s.addEventListener("selectend",Z),s.addEventListener("squeeze",Z),s.addEventListener("squeezestart",Z),s.addEventListener("squeezeend",Z),s.addEventListener("end",W),s.addEventListener("inputsourceschange",at),y.xrCompatible!==!0&&await e.makeXRCompatible(),w=t.getPixelRatio(),t.getSize(x),_&&"createProjectionLayer"in XRWebGLBinding.prototype){let xt=null,Ct=null,wt=null;y.depth&&(wt=y.stencil?e.DEPTH24_STENCIL8:e.DEPTH_COMPONENT24,xt=y.stencil?zs:Ds,Ct=y.stencil?Or:Zi);let $t={colorFormat:e.RGBA8,depthFormat:wt,scaleFactor:r};h=this.getBinding(),u=h.createProjectionLayer($t),s.updateRenderState({layers:[u]}),t.setPixelRatio(1),t.setSize(u.textureWidth,u.textureHeight,!1),v=new Xn(u.textureWidth,u.textureHeight,{format:ji,type:_i,depthTexture:new Fs(u.textureWidth,u.textureHeight,Ct,void 0,void 0,void 0,void 0,void 0,void 0,xt),stencilBuffer:y.stencil,colorSpace:t.outputColorSpace,samples:y.antialias?4:0,resolveDepthBuffer:u.ignoreDepthValues===!1,resolveStencilBuffer:u.ignoreDepthValues===!1,storeMultisampledDepthBuffer:u.ignoreDepthValues===!1,storeMultisampledStencilBuffer:u.ignoreDepthValues===!1})}else{let xt={antialias:y.antialias,alpha:!0,depth:y.depth,stencil:y.stencil,framebufferScaleFactor:r};f=new XRWebGLLayer(s,e,xt),s.updateRenderState({baseLayer:f}),t.setPixelRatio(1),t.setSize(f.framebufferWidth,f.framebufferHeight,!1),v=new Xn(f.framebufferWidth,f.framebufferHeight,{format:ji,type:_i,colorSpace:t.outputColorSpace,stencilBuffer:y.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}v.isXRRenderTarget=!0,this.setFoveation(l),c=null,o=await s.requestReferenceSpace(a),ht.setContext(s),ht.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return m.getDepthTexture()};function at(et){for(let mt=0;mt<et.removed.length;mt++){let xt=et.removed[mt],Ct=b.indexOf(xt);Ct>=0&&(b[Ct]=null,M[Ct].disconnect(xt))}for(let mt=0;mt<et.added.length;mt++){let xt=et.added[mt],Ct=b.indexOf(xt);if(Ct===-1){for(let $t=0;$t<M.length;$t++)if($t>=b.length){b.push(xt),Ct=$t;break}else if(b[$t]===null){b[$t]=xt,Ct=$t;break}if(Ct===-1)break}let wt=M[Ct];wt&&wt.connect(xt)}}function k(et,mt){mt===null?et.matrixWorld.copy(et.matrix):et.matrixWorld.multiplyMatrices(mt.matrixWorld,et.matrix),et.matrixWorldInverse.copy(et.matrixWorld).invert()}this.updateCamera=function(et){if(s===null)return;let mt=et.near,xt=et.far;m.texture!==null&&(m.depthNear>0&&(mt=m.depthNear),m.depthFar>0&&(xt=m.depthFar)),G.near=L.near=P.near=mt,G.far=L.far=P.far=xt,(D!==G.near||X!==G.far)&&(s.updateRenderState({depthNear:G.near,depthFar:G.far}),D=G.near,X=G.far),G.layers.mask=et.layers.mask|6,P.layers.mask=G.layers.mask&-5,L.layers.mask=G.layers.mask&-3;let Ct=et.parent,wt=G.cameras;k(G,Ct);for(let $t=0;$t<wt.length;$t++)k(wt[$t],Ct);G.projectionMatrix.copy(P.projectionMatrix),G.projectionMatrixInverse.copy(P.projectionMatrixInverse),O===null&&et.isPerspectiveCamera&&(O={camera:et,fov:et.fov,zoom:et.zoom}),q(et,G,Ct)};function q(et,mt,xt){xt===null?et.matrix.copy(mt.matrixWorld):(et.matrix.copy(xt.matrixWorld),et.matrix.invert(),et.matrix.multiply(mt.matrixWorld)),et.matrix.decompose(et.position,et.quaternion,et.scale),et.updateMatrixWorld(!0),et.projectionMatrix.copy(mt.projectionMatrix),et.projectionMatrixInverse.copy(mt.projectionMatrixInverse),et.isPerspectiveCamera&&(et.fov=Er*2*Math.atan(1/et.projectionMatrix.elements[5]),et.zoom=1)}this.getCamera=function(){return G},this.getFoveation=function(){if(!(u===null&&f===null))return l},this.setFoveation=function(et){l=et,u!==null&&(u.fixedFoveation=et),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=et)},this.hasDepthSensing=function(){return m.texture!==null},this.getDepthSensingMesh=function(){return m.getMesh(G)},this.getCameraTexture=function(et){return g[et]};let Q=null;function lt(et,mt){if(d=mt.getViewerPose(c||o),p=mt,d!==null){let xt=d.views;f!==null&&(t.setRenderTargetFramebuffer(v,f.framebuffer),t.setRenderTarget(v));let Ct=!1;xt.length!==G.cameras.length&&(G.cameras.length=0,Ct=!0);for(let Yt=0;Yt<xt.length;Yt++){let ge=xt[Yt],de=null;if(f!==null)de=f.getViewport(ge);else{let Qe=h.getViewSubImage(u,ge);de=Qe.viewport,Yt===0&&(t.setRenderTargetTextures(v,Qe.colorTexture,Qe.depthStencilTexture),t.setRenderTarget(v))}let oe=B[Yt];oe===void 0&&(oe=new An,oe.layers.enable(Yt),oe.viewport=new De,B[Yt]=oe),oe.matrix.fromArray(ge.transform.matrix),oe.matrix.decompose(oe.position,oe.quaternion,oe.scale),oe.projectionMatrix.fromArray(ge.projectionMatrix),oe.projectionMatrixInverse.copy(oe.projectionMatrix).invert(),oe.viewport.set(de.x,de.y,de.width,de.height),Yt===0&&(G.matrix.copy(oe.matrix),G.matrix.decompose(G.position,G.quaternion,G.scale)),Ct===!0&&G.cameras.push(oe)}let wt=s.enabledFeatures;if(wt&&wt.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&_){h=n.getBinding();let Yt=h.getDepthInformation(xt[0]);Yt&&Yt.isValid&&Yt.texture&&m.init(Yt,s.renderState)}if(wt&&wt.includes("camera-access")&&_){t.state.unbindTexture(),h=n.getBinding();for(let Yt=0;Yt<xt.length;Yt++){let ge=xt[Yt].camera;if(ge){let de=g[ge];de||(de=new Xa,g[ge]=de);let oe=h.getCameraImage(ge);de.sourceTexture=oe}}}}for(let xt=0;xt<M.length;xt++){let Ct=b[xt],wt=M[xt];Ct!==null&&wt!==void 0&&wt.update(Ct,mt,c||o)}Q&&Q(et,mt),mt.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:mt}),p=null}let ht=new Vg;ht.setAnimationLoop(lt),this.setAnimationLoop=function(et){Q=et},this.dispose=function(){}}},Ub=new Wt,jg=new re;jg.set(-1,0,0,0,1,0,0,0,1);function Fb(i,t){function e(m,g){m.matrixAutoUpdate===!0&&m.updateMatrix(),g.value.copy(m.matrix)}function n(m,g){g.color.getRGB(m.fogColor.value,rf(i)),g.isFog?(m.fogNear.value=g.near,m.fogFar.value=g.far):g.isFogExp2&&(m.fogDensity.value=g.density)}function s(m,g,y,T,v){g.isNodeMaterial?g.uniformsNeedUpdate=!1:g.isMeshBasicMaterial?r(m,g):g.isMeshLambertMaterial?(r(m,g),g.envMap&&(m.envMapIntensity.value=g.envMapIntensity)):g.isMeshToonMaterial?(r(m,g),h(m,g)):g.isMeshPhongMaterial?(r(m,g),d(m,g),g.envMap&&(m.envMapIntensity.value=g.envMapIntensity)):g.isMeshStandardMaterial?(r(m,g),u(m,g),g.isMeshPhysicalMaterial&&f(m,g,v)):g.isMeshMatcapMaterial?(r(m,g),p(m,g)):g.isMeshDepthMaterial?r(m,g):g.isMeshDistanceMaterial?(r(m,g),_(m,g)):g.isMeshNormalMaterial?r(m,g):g.isLineBasicMaterial?(o(m,g),g.isLineDashedMaterial&&a(m,g)):g.isPointsMaterial?l(m,g,y,T):g.isSpriteMaterial?c(m,g):g.isShadowMaterial?(m.color.value.copy(g.color),m.opacity.value=g.opacity):g.isShaderMaterial&&(g.uniformsNeedUpdate=!1)}function r(m,g){m.opacity.value=g.opacity,g.color&&m.diffuse.value.copy(g.color),g.emissive&&m.emissive.value.copy(g.emissive).multiplyScalar(g.emissiveIntensity),g.map&&(m.map.value=g.map,e(g.map,m.mapTransform)),g.alphaMap&&(m.alphaMap.value=g.alphaMap,e(g.alphaMap,m.alphaMapTransform)),g.bumpMap&&(m.bumpMap.value=g.bumpMap,e(g.bumpMap,m.bumpMapTransform),m.bumpScale.value=g.bumpScale,g.side===Yn&&(m.bumpScale.value*=-1)),g.normalMap&&(m.normalMap.value=g.normalMap,e(g.normalMap,m.normalMapTransform),m.normalScale.value.copy(g.normalScale),g.side===Yn&&m.normalScale.value.negate()),g.displacementMap&&(m.displacementMap.value=g.displacementMap,e(g.displacementMap,m.displacementMapTransform),m.displacementScale.value=g.displacementScale,m.displacementBias.value=g.displacementBias),g.emissiveMap&&(m.emissiveMap.value=g.emissiveMap,e(g.emissiveMap,m.emissiveMapTransform)),g.specularMap&&(m.specularMap.value=g.specularMap,e(g.specularMap,m.specularMapTransform)),g.alphaTest>0&&(m.alphaTest.value=g.alphaTest);let y=t.get(g),T=y.envMap,v=y.envMapRotation;T&&(m.envMap.value=T,m.envMapRotation.value.setFromMatrix4(Ub.makeRotationFromEuler(v)).transpose(),T.isCubeTexture&&T.isRenderTargetTexture===!1&&m.envMapRotation.value.premultiply(jg),m.reflectivity.value=g.reflectivity,m.ior.value=g.ior,m.refractionRatio.value=g.refractionRatio),g.lightMap&&(m.lightMap.value=g.lightMap,m.lightMapIntensity.value=g.lightMapIntensity,e(g.lightMap,m.lightMapTransform)),g.aoMap&&(m.aoMap.value=g.aoMap,m.aoMapIntensity.value=g.aoMapIntensity,e(g.aoMap,m.aoMapTransform))}function o(m,g){m.diffuse.value.copy(g.color),m.opacity.value=g.opacity,g.map&&(m.map.value=g.map,e(g.map,m.mapTransform))}function a(m,g){m.dashSize.value=g.dashSize,m.totalSize.value=g.dashSize+g.gapSize,m.scale.value=g.scale}function l(m,g,y,T){m.diffuse.value.copy(g.color),m.opacity.value=g.opacity,m.size.value=g.size*y,m.scale.value=T*.5,g.map&&(m.map.value=g.map,e(g.map,m.uvTransform)),g.alphaMap&&(m.alphaMap.value=g.alphaMap,e(g.alphaMap,m.alphaMapTransform)),g.alphaTest>0&&(m.alphaTest.value=g.alphaTest)}function c(m,g){m.diffuse.value.copy(g.color),m.opacity.value=g.opacity,m.rotation.value=g.rotation,g.map&&(m.map.value=g.map,e(g.map,m.mapTransform)),g.alphaMap&&(m.alphaMap.value=g.alphaMap,e(g.alphaMap,m.alphaMapTransform)),g.alphaTest>0&&(m.alphaTest.value=g.alphaTest)}function d(m,g){m.specular.value.copy(g.specular),m.shininess.value=Math.max(g.shininess,1e-4)}function h(m,g){g.gradientMap&&(m.gradientMap.value=g.gradientMap)}function u(m,g){m.metalness.value=g.metalness,g.metalnessMap&&(m.metalnessMap.value=g.metalnessMap,e(g.metalnessMap,m.metalnessMapTransform)),m.roughness.value=g.roughness,g.roughnessMap&&(m.roughnessMap.value=g.roughnessMap,e(g.roughnessMap,m.roughnessMapTransform)),g.envMap&&(m.envMapIntensity.value=g.envMapIntensity)}function f(m,g,y){m.ior.value=g.ior,g.diffuseRoughness>0&&(m.diffuseRoughness.value=g.diffuseRoughness,g.diffuseRoughnessMap&&(m.diffuseRoughnessMap.value=g.diffuseRoughnessMap,e(g.diffuseRoughnessMap,m.diffuseRoughnessMapTransform))),g.sheen>0&&(m.sheenColor.value.copy(g.sheenColor).multiplyScalar(g.sheen),m.sheenRoughness.value=g.sheenRoughness,g.sheenColorMap&&(m.sheenColorMap.value=g.sheenColorMap,e(g.sheenColorMap,m.sheenColorMapTransform)),g.sheenRoughnessMap&&(m.sheenRoughnessMap.value=g.sheenRoughnessMap,e(g.sheenRoughnessMap,m.sheenRoughnessMapTransform))),g.clearcoat>0&&(m.clearcoat.value=g.clearcoat,m.clearcoatRoughness.value=g.clearcoatRoughness,g.clearcoatMap&&(m.clearcoatMap.value=g.clearcoatMap,e(g.clearcoatMap,m.clearcoatMapTransform)),g.clearcoatRoughnessMap&&(m.clearcoatRoughnessMap.value=g.clearcoatRoughnessMap,e(g.clearcoatRoughnessMap,m.clearcoatRoughnessMapTransform)),g.clearcoatNormalMap&&(m.clearcoatNormalMap.value=g.clearcoatNormalMap,e(g.clearcoatNormalMap,m.clearcoatNormalMapTransform),m.clearcoatNormalScale.value.copy(g.clearcoatNormalScale),g.side===Yn&&m.clearcoatNormalScale.value.negate())),g.dispersion>0&&(m.dispersion.value=g.dispersion),g.retroreflectivity>0&&(m.retroreflectivity.value=g.retroreflectivity),g.iridescence>0&&(m.iridescence.value=g.iridescence,m.iridescenceIOR.value=g.iridescenceIOR,m.iridescenceThicknessMinimum.value=g.iridescenceThicknessMinimum,m.iridescenceThicknessMaximum.value=g.iridescenceThicknessMaximum,g.iridescenceMap&&(m.iridescenceMap.value=g.iridescenceMap,e(g.iridescenceMap,m.iridescenceMapTransform)),g.iridescenceThicknessMap&&(m.iridescenceThicknessMap.value=g.iridescenceThicknessMap,e(g.iridescenceThicknessMap,m.iridescenceThicknessMapTransform))),g.transmission>0&&(m.transmission.value=g.transmission,m.transmissionSamplerMap.value=y.texture,m.transmissionSamplerSize.value.set(y.width,y.height),g.transmissionMap&&(m.transmissionMap.value=g.transmissionMap,e(g.transmissionMap,m.transmissionMapTransform)),m.thickness.value=g.thickness,g.thicknessMap&&(m.thicknessMap.value=g.thicknessMap,e(g.thicknessMap,m.thicknessMapTransform)),m.attenuationDistance.value=g.attenuationDistance,m.attenuationColor.value.copy(g.attenuationColor)),g.anisotropy>0&&(m.anisotropyVector.value.set(g.anisotropy*Math.cos(g.anisotropyRotation),g.anisotropy*Math.sin(g.anisotropyRotation)),g.anisotropyMap&&(m.anisotropyMap.value=g.anisotropyMap,e(g.anisotropyMap,m.anisotropyMapTransform))),m.specularIntensity.value=g.specularIntensity,m.specularColor.value.copy(g.specularColor),g.specularColorMap&&(m.specularColorMap.value=g.specularColorMap,e(g.specularColorMap,m.specularColorMapTransform)),g.specularIntensityMap&&(m.specularIntensityMap.value=g.specularIntensityMap,e(g.specularIntensityMap,m.specularIntensityMapTransform))}function p(m,g){g.matcap&&(m.matcap.value=g.matcap)}function _(m,g){let y=t.get(g).light;m.referencePosition.value.setFromMatrixPosition(y.matrixWorld),m.nearDistance.value=y.shadow.camera.near,m.farDistance.value=y.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function Bb(i,t,e,n){let s={},r={};function o(y,T){let v=T.program;n.uniformBlockBinding(y,v,s[y.id])}function a(y,T){let v=s[y.id];v===void 0&&(p(y),v=l(y),s[y.id]=v,y.addEventListener("dispose",m));let M=T.program;n.updateUBOMapping(y,M);let b=t.render.frame;r[y.id]!==b&&(c(y),r[y.id]=b)}function l(y){let T=i.createBuffer(),v=y.__size,M=y.usage;return i.bindBuffer(i.UNIFORM_BUFFER,T),i.bufferData(i.UNIFORM_BUFFER,v,M),i.bindBuffer(i.UNIFORM_BUFFER,null),T}function c(y){let T=s[y.id],v=y.uniforms,M=y.__cache;i.bindBuffer(i.UNIFORM_BUFFER,T);for(let b=0,x=v.length;b<x;b++){let w=v[b];if(Array.isArray(w))for(let O=0,P=w.length;O<P;O++)d(w[O],b,O,M);else d(w,b,0,M)}i.bindBuffer(i.UNIFORM_BUFFER,null)}function d(y,T,v,M){if(u(y,T,v,M)===!0){let b=y.__offset,x=y.value;if(Array.isArray(x)){let w=0;for(let O=0;O<x.length;O++){let P=x[O],L=_(P,!0);h(P,y.__data,w),w+=L.storage/Float32Array.BYTES_PER_ELEMENT}}else h(x,y.__data,0);i.bufferSubData(i.UNIFORM_BUFFER,b,y.__data)}}function h(y,T,v){typeof y=="number"||typeof y=="boolean"?T[v]=y:y.isMatrix3?(T[v]=y.elements[0],T[v+1]=y.elements[1],T[v+2]=y.elements[2],T[v+3]=0,T[v+4]=y.elements[3],T[v+5]=y.elements[4],T[v+6]=y.elements[5],T[v+7]=0,T[v+8]=y.elements[6],T[v+9]=y.elements[7],T[v+10]=y.elements[8],T[v+11]=0):ArrayBuffer.isView(y)?T.set(y.subarray(0,T.length-v),v):y.toArray(T,v)}function u(y,T,v,M){let b=y.value,x=T+"_"+v;if(Array.isArray(b)){M[x]===void 0&&(M[x]=[]);let w=M[x],O=!1;for(let P=0;P<b.length;P++)f(b[P],w,P)===!0&&(O=!0);return O}return f(b,M,x)}function f(y,T,v){if(T[v]===void 0)return typeof y=="number"||typeof y=="boolean"?T[v]=y:ArrayBuffer.isView(y)?T[v]=y.slice():T[v]=y.clone(),!0;{let M=T[v];if(typeof y=="number"||typeof y=="boolean"){if(M!==y)return T[v]=y,!0}else{if(ArrayBuffer.isView(y))return!0;if(M.equals(y)===!1)return M.copy(y),!0}}return!1}function p(y){let T=y.uniforms,v=0,M=16;for(let x=0,w=T.length;x<w;x++){let O=Array.isArray(T[x])?T[x]:[T[x]];for(let P=0,L=O.length;P<L;P++){let B=O[P],G=Array.isArray(B.value)?B.value:[B.value],D=Array.isArray(T[x])||Array.isArray(B.value),X=v;for(let W=0,at=G.length;W<at;W++){let k=G[W],q=_(k,D),Q=v%M,lt=Q%q.boundary,ht=Q+lt;v+=lt,ht!==0&&M-ht<q.storage&&(v+=M-ht),W===0&&(X=v),v+=q.storage}let Z=B.type==="int"?Int32Array:B.type==="uint"?Uint32Array:Float32Array;B.__data=new Z((v-X)/Float32Array.BYTES_PER_ELEMENT),B.__offset=X}}let b=v%M;return b>0&&(v+=M-b),y.__size=v,y.__cache={},this}function _(y,T){let v={boundary:0,storage:0};return typeof y=="number"||typeof y=="boolean"?(v.boundary=4,v.storage=4):y.isVector2?(v.boundary=8,v.storage=8):y.isVector3||y.isColor?(v.boundary=16,v.storage=12):y.isVector4?(v.boundary=16,v.storage=16):y.isMatrix3?(v.boundary=16,v.storage=48):y.isMatrix4?(v.boundary=16,v.storage=64):y.isTexture?jt("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(y)?(v.boundary=16,v.storage=y.byteLength):jt("WebGLRenderer: Unsupported uniform value type.",y),T===!0&&(v.boundary=16,v.storage=Math.ceil(v.storage/16)*16),v}function m(y){let T=y.target;T.removeEventListener("dispose",m),i.deleteBuffer(s[T.id]),delete s[T.id],delete r[T.id]}function g(){for(let y in s)i.deleteBuffer(s[y]);s={},r={}}return{bind:o,update:a,dispose:g}}var kb=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),fs=null;function zb(){return fs===null&&(fs=new Ar(kb,16,16,fr,Ji),fs.name="DFG_LUT",fs.minFilter=ci,fs.magFilter=ci,fs.wrapS=hs,fs.wrapT=hs,fs.generateMipmaps=!1,fs.needsUpdate=!0),fs}var Bh=class{constructor(t={}){let{canvas:e=dg(),context:n=null,depth:s=!0,stencil:r=!1,alpha:o=!1,antialias:a=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:d="default",failIfMajorPerformanceCaveat:h=!1,reversedDepthBuffer:u=!1,outputBufferType:f=_i}=t;this.isWebGLRenderer=!0;let p;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");p=n.getContextAttributes().alpha}else p=o;let _=f,m=new Set([ih,nh,eh]),g=new Set([_i,Zi,Wo,Or,Kc,Qc]),y=new Uint32Array(4),T=new Int32Array(4),v={textures:[],min:[],max:[],resolution:[]},M=null,b=null,x=[],w=[],O=null;this.domElement=e,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=ds,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let P=this,L=!1,B=null,G=null,D=null,X=null;this._outputColorSpace=Te;let Z=0,W=0,at=null,k=-1,q=null,Q=new De,lt=new De,ht=null,et=new Xt(0),mt=0,xt=e.width,Ct=e.height,wt=1,$t=null,le=null,Yt=new De(0,0,xt,Ct),ge=new De(0,0,xt,Ct),de=!1,oe=new nr,Qe=new Rc,Xe=!1,mn=!1,Be=new Wt,Nn=new R,we=new De,bn={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},an=!1;function gn(){return at===null?wt:1}let V=n;function Pt(C,H){return e.getContext(C,H)}let Kt,ce,bt,Ve,Ht,Jt,I,E,$,dt,ot,_t,yt,nt,st,pt,z,rt,it,Tt,gt,Mt,qt;try{let C={alpha:!0,depth:s,stencil:r,antialias:a,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:d,failIfMajorPerformanceCaveat:h};if("setAttribute"in e&&e.setAttribute("data-engine",`three.js r${"187"}`),e.addEventListener("webglcontextlost",zt,!1),e.addEventListener("webglcontextrestored",ne,!1),e.addEventListener("webglcontextcreationerror",Rt,!1),V===null){let H="webgl2";if(V=Pt(H,C),V===null)throw Pt(H)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}ee()}catch(C){throw e.removeEventListener("webglcontextlost",zt,!1),e.removeEventListener("webglcontextrestored",ne,!1),e.removeEventListener("webglcontextcreationerror",Rt,!1),te("WebGLRenderer: "+C.message),C}function ee(){Kt=new jM(V),Kt.init(),gt=new Db(V,Kt),ce=new zM(V,Kt,t,gt),bt=new Ib(V,Kt),ce.reversedDepthBuffer&&u&&bt.buffers.depth.setReversed(!0),G=V.createFramebuffer(),D=V.createFramebuffer(),X=V.createFramebuffer(),Ve=new tw(V),Ht=new _b,Jt=new Lb(V,Kt,bt,Ht,ce,gt,Ve),I=new JM(P),E=new nv(V),Mt=new BM(V,E),$=new KM(V,E,Ve,Mt),dt=new nw(V,$,E,Mt,Ve),rt=new ew(V,ce,Jt),st=new VM(Ht),ot=new gb(P,I,Kt,ce,Mt,st),_t=new Fb(P,Ht),yt=new yb,nt=new Tb(Kt),z=new FM(P,I,bt,dt,p,l),pt=new Pb(P,dt,ce),qt=new Bb(V,Ve,ce,bt),it=new kM(V,Kt,Ve),Tt=new QM(V,Kt,Ve),Ve.programs=ot.programs,P.capabilities=ce,P.extensions=Kt,P.properties=Ht,P.renderLists=yt,P.shadowMap=pt,P.state=bt,P.info=Ve}_!==_i&&(O=new sw(_,e.width,e.height,a,s,r));let ut=new xf(P,V);this.xr=ut,this.getContext=function(){return V},this.getContextAttributes=function(){return V.getContextAttributes()},this.forceContextLoss=function(){let C=Kt.get("WEBGL_lose_context");C&&C.loseContext()},this.forceContextRestore=function(){let C=Kt.get("WEBGL_lose_context");C&&C.restoreContext()},this.getPixelRatio=function(){return wt},this.setPixelRatio=function(C){C!==void 0&&(wt=C,this.setSize(xt,Ct,!1))},this.getSize=function(C){return C.set(xt,Ct)},this.setSize=function(C,H,tt=!0){if(ut.isPresenting){jt("WebGLRenderer: Can't change size while VR device is presenting.");return}xt=C,Ct=H,e.width=Math.floor(C*wt),e.height=Math.floor(H*wt),tt===!0&&(e.style.width=C+"px",e.style.height=H+"px"),O!==null&&O.setSize(e.width,e.height),this.setViewport(0,0,C,H)},this.getDrawingBufferSize=function(C){return C.set(xt*wt,Ct*wt).floor()},this.setDrawingBufferSize=function(C,H,tt){xt=C,Ct=H,wt=tt,e.width=Math.floor(C*tt),e.height=Math.floor(H*tt),this.setViewport(0,0,C,H)},this.setEffects=function(C){if(_===_i){te("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(C){for(let H=0;H<C.length;H++)if(C[H].isOutputPass===!0){jt("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}O.setEffects(C||[])},this.getCurrentViewport=function(C){return C.copy(Q)},this.getViewport=function(C){return C.copy(Yt)},this.setViewport=function(C,H,tt,J){C.isVector4?Yt.set(C.x,C.y,C.z,C.w):Yt.set(C,H,tt,J),bt.viewport(Q.copy(Yt).multiplyScalar(gn()).round())},this.getScissor=function(C){return C.copy(ge)},this.setScissor=function(C,H,tt,J){C.isVector4?ge.set(C.x,C.y,C.z,C.w):ge.set(C,H,tt,J),bt.scissor(lt.copy(ge).multiplyScalar(gn()).round())},this.getScissorTest=function(){return de},this.setScissorTest=function(C){bt.setScissorTest(de=C)},this.setOpaqueSort=function(C){$t=C},this.setTransparentSort=function(C){le=C},this.getClearColor=function(C){return C.copy(z.getClearColor())},this.setClearColor=function(){z.setClearColor(...arguments)},this.getClearAlpha=function(){return z.getClearAlpha()},this.setClearAlpha=function(){z.setClearAlpha(...arguments)},this.clear=function(C=!0,H=!0,tt=!0){let J=0;if(C){let j=!1;if(at!==null){let Et=at.texture.format;j=m.has(Et)}if(j){let Et=at.texture.type,Dt=g.has(Et),At=z.getClearColor(),Nt=z.getClearAlpha(),Gt=At.r,se=At.g,_e=At.b;Dt?(y[0]=Gt,y[1]=se,y[2]=_e,y[3]=Nt,V.clearBufferuiv(V.COLOR,0,y)):(T[0]=Gt,T[1]=se,T[2]=_e,T[3]=Nt,V.clearBufferiv(V.COLOR,0,T))}else J|=V.COLOR_BUFFER_BIT}H&&(J|=V.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),tt&&(J|=V.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),J!==0&&V.clear(J)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(C){C.setRenderer(this),B=C},this.dispose=function(){e.removeEventListener("webglcontextlost",zt,!1),e.removeEventListener("webglcontextrestored",ne,!1),e.removeEventListener("webglcontextcreationerror",Rt,!1),z.dispose(),yt.dispose(),nt.dispose(),Jt.dispose(),Ht.dispose(),I.dispose(),dt.dispose(),$.dispose(),Mt.dispose(),qt.dispose(),ot.dispose(),ut.dispose(),ut.removeEventListener("sessionstart",Ol),ut.removeEventListener("sessionend",ns),Ss.stop()};function zt(C){C.preventDefault(),Na("WebGLRenderer: Context Lost."),L=!0}function ne(){Na("WebGLRenderer: Context Restored."),L=!1;let C=Ve.autoReset,H=pt.enabled,tt=pt.autoUpdate,J=pt.needsUpdate,j=pt.type;ee(),Ve.autoReset=C,pt.enabled=H,pt.autoUpdate=tt,pt.needsUpdate=J,pt.type=j}function Rt(C){te("WebGLRenderer: A WebGL context could not be created. Reason: ",C.statusMessage)}function ue(C){let H=C.target;H.removeEventListener("dispose",ue),qe(H)}function qe(C){ii(C),Ht.remove(C)}function ii(C){let H=Ht.get(C).programs;H!==void 0&&(H.forEach(function(tt){ot.releaseProgram(tt)}),C.isShaderMaterial&&ot.releaseShaderCache(C))}this.renderBufferDirect=function(C,H,tt,J,j,Et){H===null&&(H=bn);let Dt=j.isMesh&&j.matrixWorld.determinantAffine()<0,At=da(C,H,tt,J,j);bt.setMaterial(J,Dt);let Nt=tt.index,Gt=1;if(J.wireframe===!0){if(Nt=$.getWireframeAttribute(tt),Nt===void 0)return;Gt=2}let se=tt.drawRange,_e=tt.attributes.position,Vt=se.start*Gt,xe=(se.start+se.count)*Gt;Et!==null&&(Vt=Math.max(Vt,Et.start*Gt),xe=Math.min(xe,(Et.start+Et.count)*Gt)),Nt!==null?(Vt=Math.max(Vt,0),xe=Math.min(xe,Nt.count)):_e!=null&&(Vt=Math.max(Vt,0),xe=Math.min(xe,_e.count));let sn=xe-Vt;if(sn<0||sn===1/0)return;Mt.setup(j,J,At,tt,Nt);let Oe,Ue=it;if(Nt!==null&&(Oe=E.get(Nt),Ue=Tt,Ue.setIndex(Oe)),j.isMesh)J.wireframe===!0?(bt.setLineWidth(J.wireframeLinewidth*gn()),Ue.setMode(V.LINES)):Ue.setMode(V.TRIANGLES);else if(j.isLine){let Tn=J.linewidth;Tn===void 0&&(Tn=1),bt.setLineWidth(Tn*gn()),j.isLineSegments?Ue.setMode(V.LINES):j.isLineLoop?Ue.setMode(V.LINE_LOOP):Ue.setMode(V.LINE_STRIP)}else j.isPoints?Ue.setMode(V.POINTS):j.isSprite&&Ue.setMode(V.TRIANGLES);if(j.isBatchedMesh)if(Kt.get("WEBGL_multi_draw"))Ue.renderMultiDraw(j._multiDrawStarts,j._multiDrawCounts,j._multiDrawCount);else{let Tn=j._multiDrawStarts,Ft=j._multiDrawCounts,_n=j._multiDrawCount,ve=Nt?E.get(Nt).bytesPerElement:1,ws=Ht.get(J).currentProgram.getUniforms();for(let xn=0;xn<_n;xn++)ws.setValue(V,"_gl_DrawID",xn),Ue.render(Tn[xn]/ve,Ft[xn])}else if(j.isInstancedMesh)Ue.renderInstances(Vt,sn,j.count);else if(tt.isInstancedBufferGeometry){let Tn=tt._maxInstanceCount!==void 0?tt._maxInstanceCount:1/0,Ft=Math.min(tt.instanceCount,Tn);Ue.renderInstances(Vt,sn,Ft)}else Ue.render(Vt,sn)};function ca(C,H,tt,J){B!==null&&C.isNodeMaterial&&B.setObject(J,C),Xe===!0&&st.setState(C,tt,!1),C.transparent===!0&&C.side===Mn&&C.forceSinglePass===!1?(C.side=Yn,C.needsUpdate=!0,is(C,H,J),C.side=dr,C.needsUpdate=!0,is(C,H,J),C.side=Mn):is(C,H,J)}this.compile=function(C,H,tt=null){tt===null&&(tt=C),B!==null&&B.renderStart(C,H,tt),b=nt.get(tt),b.init(H),w.push(b),tt.traverseVisible(function(j){j.isLight&&j.layers.test(H.layers)&&(b.pushLight(j),j.castShadow&&b.pushShadow(j))}),C!==tt&&C.traverseVisible(function(j){j.isLight&&j.layers.test(H.layers)&&(b.pushLight(j),j.castShadow&&b.pushShadow(j))}),b.setupLights(),B!==null&&B.updateLights(b.state.lightsArray),mn=this.localClippingEnabled,Xe=st.init(this.clippingPlanes,mn),Xe===!0&&st.setGlobalState(this.clippingPlanes,H),B!==null&&pt.render(b.state.shadowsArray,tt,H);let J=new Set;return C.traverse(function(j){if(!(j.isMesh||j.isPoints||j.isLine||j.isSprite))return;let Et=j.material;if(Et)if(Array.isArray(Et))for(let Dt=0;Dt<Et.length;Dt++){let At=Et[Dt];ca(At,tt,H,j),J.add(At)}else ca(Et,tt,H,j),J.add(Et)}),b=w.pop(),B!==null&&B.renderEnd(),J},this.compileAsync=function(C,H,tt=null){let J=this.compile(C,H,tt);return new Promise(j=>{function Et(){if(J.forEach(function(Dt){let Nt=Ht.get(Dt).currentProgram;(Nt===void 0||Nt.isReady())&&J.delete(Dt)}),J.size===0){j(C);return}setTimeout(Et,10)}Kt.get("KHR_parallel_shader_compile")!==null?Et():setTimeout(Et,10)})};let $r=null;function Bu(C){$r&&$r(C)}function Ol(){Ss.stop()}function ns(){Ss.start()}let Ss=new Vg;Ss.setAnimationLoop(Bu),typeof self<"u"&&Ss.setContext(self),this.setAnimationLoop=function(C){$r=C,ut.setAnimationLoop(C),C===null?Ss.stop():Ss.start()},ut.addEventListener("sessionstart",Ol),ut.addEventListener("sessionend",ns),this.render=function(C,H){if(H!==void 0&&H.isCamera!==!0){te("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(L===!0)return;B!==null&&B.renderStart(C,H);let tt=ut.enabled===!0&&ut.isPresenting===!0,J=O!==null&&(at===null||tt)&&O.begin(P,at);if(C.matrixWorldAutoUpdate===!0&&C.updateMatrixWorld(),H.parent===null&&H.matrixWorldAutoUpdate===!0&&H.updateMatrixWorld(),ut.enabled===!0&&ut.isPresenting===!0&&(O===null||O.isCompositing()===!1)&&(ut.cameraAutoUpdate===!0&&ut.updateCamera(H),H=ut.getCamera()),C.isScene===!0&&C.onBeforeRender(P,C,H,at),b=nt.get(C,w.length),b.init(H),b.state.textureUnits=Jt.getTextureUnits(),w.push(b),Be.multiplyMatrices(H.projectionMatrix,H.matrixWorldInverse),H.isArrayCamera?Qe.setFromArrayCamera(H):oe.setFromProjectionMatrix(Be,Oi,H.reversedDepth),mn=this.localClippingEnabled,Xe=st.init(this.clippingPlanes,mn),M=yt.get(C,x.length),M.init(),x.push(M),this.info.render.frame++,ut.enabled===!0&&ut.isPresenting===!0){let Dt=P.xr.getDepthSensingMesh();Dt!==null&&Ms(Dt,H,-1/0,P.sortObjects)}Ms(C,H,0,P.sortObjects),M.finish(),B!==null&&B.updateLights(b.state.lightsArray),P.sortObjects===!0&&M.sort($t,le),an=ut.enabled===!1||ut.isPresenting===!1||ut.hasDepthSensing()===!1,an&&z.addToRenderList(M,C),this.info.autoReset===!0&&this.info.reset(),Xe===!0&&st.beginShadows();let j=b.state.shadowsArray;if(pt.render(j,C,H),Xe===!0&&st.endShadows(),(J&&O.hasRenderPass())===!1){let Dt=M.opaque,At=M.transmissive;if(b.setupLights(),H.isArrayCamera){let Nt=H.cameras;if(At.length>0)for(let Gt=0,se=Nt.length;Gt<se;Gt++){let _e=Nt[Gt];Gi(Dt,At,C,_e)}an&&z.render(C);for(let Gt=0,se=Nt.length;Gt<se;Gt++){let _e=Nt[Gt];ha(M,C,_e,_e.viewport)}}else At.length>0&&Gi(Dt,At,C,H),an&&z.render(C),ha(M,C,H)}at!==null&&W===0&&(Jt.updateMultisampleRenderTarget(at),Jt.updateRenderTargetMipmap(at)),J&&O.end(P),C.isScene===!0&&C.onAfterRender(P,C,H),Mt.resetDefaultState(),k=-1,q=null,w.pop(),w.length>0?(b=w[w.length-1],Jt.setTextureUnits(b.state.textureUnits),Xe===!0&&st.setGlobalState(P.clippingPlanes,b.state.camera)):b=null,x.pop(),x.length>0?M=x[x.length-1]:M=null,B!==null&&B.renderEnd()};function Ms(C,H,tt,J){if(C.visible===!1)return;if(C.layers.test(H.layers)){if(C.isGroup)tt=C.renderOrder;else if(C.isLOD)C.autoUpdate===!0&&C.update(H);else if(C.isLight)b.pushLight(C),C.castShadow&&b.pushShadow(C);else if(C.isSprite){let Dt=H.isArrayCamera?Qe:oe;if(!C.frustumCulled||C.intersectsFrustum(Dt)){J&&we.setFromMatrixPosition(C.matrixWorld).applyMatrix4(Be);let At=dt.update(C),Nt=C.material;Nt.visible&&M.push(C,At,Nt,tt,we.z,null,H)}}else if(C.isMesh||C.isLine||C.isPoints){let Dt=H.isArrayCamera?Qe:oe;if(!C.frustumCulled||C.intersectsFrustum(Dt)){let At=dt.update(C),Nt=C.material;if(J&&(C.boundingSphere!==void 0?(C.boundingSphere===null&&C.computeBoundingSphere(),we.copy(C.boundingSphere.center)):(At.boundingSphere===null&&At.computeBoundingSphere(),we.copy(At.boundingSphere.center)),we.applyMatrix4(C.matrixWorld).applyMatrix4(Be)),Array.isArray(Nt)){let Gt=At.groups;for(let se=0,_e=Gt.length;se<_e;se++){let Vt=Gt[se],xe=Nt[Vt.materialIndex];xe&&xe.visible&&M.push(C,At,xe,tt,we.z,Vt,H)}}else Nt.visible&&M.push(C,At,Nt,tt,we.z,null,H)}}}let Et=C.children;for(let Dt=0,At=Et.length;Dt<At;Dt++)Ms(Et[Dt],H,tt,J)}function ha(C,H,tt,J){let{opaque:j,transmissive:Et,transparent:Dt}=C;b.setupLightsView(tt),Xe===!0&&st.setGlobalState(P.clippingPlanes,tt),J&&bt.viewport(Q.copy(J)),j.length>0&&ln(j,H,tt),Et.length>0&&ln(Et,H,tt),Dt.length>0&&ln(Dt,H,tt),bt.buffers.depth.setTest(!0),bt.buffers.depth.setMask(!0),bt.buffers.color.setMask(!0),bt.setPolygonOffset(!1)}function Gi(C,H,tt,J){if((tt.isScene===!0?tt.overrideMaterial:null)!==null)return;if(b.state.transmissionRenderTarget[J.id]===void 0){let Vt=Kt.has("EXT_color_buffer_half_float")||Kt.has("EXT_color_buffer_float");b.state.transmissionRenderTarget[J.id]=new Xn(1,1,{generateMipmaps:!0,type:Vt?Ji:_i,minFilter:ks,samples:Math.max(4,ce.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:Se.workingColorSpace})}let Et=b.state.transmissionRenderTarget[J.id],Dt=J.viewport||Q;Et.setSize(Dt.z*P.transmissionResolutionScale,Dt.w*P.transmissionResolutionScale);let At=P.getRenderTarget(),Nt=P.getActiveCubeFace(),Gt=P.getActiveMipmapLevel();P.setRenderTarget(Et),P.getClearColor(et),mt=P.getClearAlpha(),mt<1&&P.setClearColor(16777215,.5),P.clear(),an&&z.render(tt);let se=P.toneMapping;P.toneMapping=ds;let _e=J.viewport;if(J.viewport!==void 0&&(J.viewport=void 0),b.setupLightsView(J),Xe===!0&&st.setGlobalState(P.clippingPlanes,J),ln(C,tt,J),Jt.updateMultisampleRenderTarget(Et),Jt.updateRenderTargetMipmap(Et),Kt.has("WEBGL_multisampled_render_to_texture")===!1){let Vt=!1;for(let xe=0,sn=H.length;xe<sn;xe++){let Oe=H[xe],{object:Ue,geometry:Tn,material:Ft,group:_n}=Oe;if(Ft.side===Mn&&Ue.layers.test(J.layers)){let ve=Ft.side;Ft.side=Yn,Ft.needsUpdate=!0,fn(Ue,tt,J,Tn,Ft,_n),Ft.side=ve,Ft.needsUpdate=!0,Vt=!0}}Vt===!0&&(Jt.updateMultisampleRenderTarget(Et),Jt.updateRenderTargetMipmap(Et))}P.setRenderTarget(At,Nt,Gt),P.setClearColor(et,mt),_e!==void 0&&(J.viewport=_e),P.toneMapping=se}function ln(C,H,tt){let J=H.isScene===!0?H.overrideMaterial:null;for(let j=0,Et=C.length;j<Et;j++){let Dt=C[j],{object:At,geometry:Nt,group:Gt}=Dt,se=Dt.material;se.allowOverride===!0&&J!==null&&(se=J),At.layers.test(tt.layers)&&fn(At,H,tt,Nt,se,Gt)}}function fn(C,H,tt,J,j,Et){B!==null&&j.isNodeMaterial&&B.setObject(C,j),C.onBeforeRender(P,H,tt,J,j,Et),C.modelViewMatrix.multiplyMatrices(tt.matrixWorldInverse,C.matrixWorld),C.normalMatrix.getNormalMatrix(C.modelViewMatrix),j.onBeforeRender(P,H,tt,J,C,Et),j.transparent===!0&&j.side===Mn&&j.forceSinglePass===!1?(j.side=Yn,j.needsUpdate=!0,P.renderBufferDirect(tt,H,J,j,C,Et),j.side=dr,j.needsUpdate=!0,P.renderBufferDirect(tt,H,J,j,C,Et),j.side=Mn):P.renderBufferDirect(tt,H,J,j,C,Et),C.onAfterRender(P,H,tt,J,j,Et)}function pn(C){let H=0;for(let tt of C)tt.texture!==null&&H++;return H}function is(C,H,tt){H.isScene!==!0&&(H=bn);let J=Ht.get(C),j=b.state.lights,Et=b.state.shadowsArray,Dt=j.state.version,At=ot.getParameters(C,j.state,Et,H,tt,b.state.lightProbeGridArray),Nt=ot.getProgramCacheKey(At),Gt=J.programs;J.environment=C.isMeshStandardMaterial||C.isMeshLambertMaterial||C.isMeshPhongMaterial?H.environment:null,J.fog=H.fog;let se=C.isMeshStandardMaterial||C.isMeshLambertMaterial&&!C.envMap||C.isMeshPhongMaterial&&!C.envMap;J.envMap=I.get(C.envMap||J.environment,se),J.envMapRotation=J.environment!==null&&C.envMap===null?H.environmentRotation:C.envMapRotation,Gt===void 0&&(C.addEventListener("dispose",ue),Gt=new Map,J.programs=Gt,J.programVariants=new Map);let _e=Gt.get(Nt);if(_e!==void 0){if(J.currentProgram===_e&&J.lightsStateVersion===Dt)return ua(C,At),_e}else At.uniforms=ot.getUniforms(C),B!==null&&C.isNodeMaterial&&B.build(C,tt,At),C.onBeforeCompile(At,P),_e=ot.acquireProgram(At,Nt),Gt.set(Nt,_e),J.uniforms=At.uniforms;let Vt=J.uniforms;return(!C.isShaderMaterial&&!C.isRawShaderMaterial||C.clipping===!0)&&(Vt.clippingPlanes=st.uniform),ua(C,At),J.needsLights=Ys(C),J.lightsStateVersion=Dt,J.needsLights&&(Vt.ambientLightColor.value=j.state.ambient,Vt.lightProbe.value=j.state.probe,Vt.sunLights.value=j.state.sun,Vt.sunLightShadows.value=j.state.sunShadow,Vt.directionalLights.value=j.state.directional,Vt.directionalLightShadows.value=j.state.directionalShadow,Vt.spotLights.value=j.state.spot,Vt.spotLightShadows.value=j.state.spotShadow,Vt.rectAreaLights.value=j.state.rectArea,Vt.ltc_1.value=j.state.rectAreaLTC1,Vt.ltc_2.value=j.state.rectAreaLTC2,Vt.pointLights.value=j.state.point,Vt.pointLightShadows.value=j.state.pointShadow,Vt.hemisphereLights.value=j.state.hemi,Vt.sunShadowMatrix.value=j.state.sunShadowMatrix,Vt.sunShadowCascade.value=j.state.sunShadowCascade,Vt.directionalShadowMatrix.value=j.state.directionalShadowMatrix,Vt.spotLightMatrix.value=j.state.spotLightMatrix,Vt.spotLightMap.value=j.state.spotLightMap,Vt.pointShadowMatrix.value=j.state.pointShadowMatrix),J.numLightProbeGrids=pn(b.state.lightProbeGridArray),J.currentProgram=_e,J.uniformsList=null,_e}function vi(C,H,tt,J,j){let Et=Ht.get(C),Dt=Et.currentProgram.id+","+J+","+j,At=Et.programVariants.get(Dt);return At===void 0?(At=is(C,H,tt),Et.programVariants.set(Dt,At)):(Et.currentProgram=At,Et.uniformsList=null,Et.outputColorSpace=J,Et.toneMapping=j),At}function Xs(C){if(C.uniformsList===null){let H=C.currentProgram.getUniforms();C.uniformsList=Xo.seqWithValue(H.seq,C.uniforms)}return C.uniformsList}function ua(C,H){let tt=Ht.get(C);tt.outputColorSpace=H.outputColorSpace,tt.batching=H.batching,tt.batchingColor=H.batchingColor,tt.instancing=H.instancing,tt.instancingColor=H.instancingColor,tt.instancingMorph=H.instancingMorph,tt.skinning=H.skinning,tt.morphTargets=H.morphTargets,tt.morphNormals=H.morphNormals,tt.morphColors=H.morphColors,tt.morphTargetsCount=H.morphTargetsCount,tt.numClippingPlanes=H.numClippingPlanes,tt.numIntersection=H.numClipIntersection,tt.vertexAlphas=H.vertexAlphas,tt.vertexTangents=H.vertexTangents,tt.toneMapping=H.toneMapping}function da(C,H,tt,J,j){H.isScene!==!0&&(H=bn),Jt.resetTextureUnits();let Et=H.fog,Dt=J.isMeshStandardMaterial||J.isMeshLambertMaterial||J.isMeshPhongMaterial?H.environment:null,At=at===null?P.outputColorSpace:at.isXRRenderTarget===!0?at.texture.colorSpace:Se.workingColorSpace,Nt=J.isMeshStandardMaterial||J.isMeshLambertMaterial&&!J.envMap||J.isMeshPhongMaterial&&!J.envMap,Gt=I.get(J.envMap||Dt,Nt),se=J.vertexColors===!0&&!!tt.attributes.color&&tt.attributes.color.itemSize===4,_e=!!tt.attributes.tangent&&(!!J.normalMap||J.anisotropy>0),Vt=!!tt.morphAttributes.position,xe=!!tt.morphAttributes.normal,sn=!!tt.morphAttributes.color,Oe=ds;J.toneMapped&&(at===null||at.isXRRenderTarget===!0)&&(Oe=P.toneMapping);let Ue=tt.morphAttributes.position||tt.morphAttributes.normal||tt.morphAttributes.color,Tn=Ue!==void 0?Ue.length:0,Ft=Ht.get(J),_n=b.state.lights;if(Xe===!0&&(mn===!0||C!==q)){let Fe=C===q&&J.id===k;st.setState(J,C,Fe)}let ve=!1,ws=!1;J.version===Ft.__version?Ft.needsLights&&Ft.lightsStateVersion!==_n.state.version||j.isBatchedMesh&&Ft.batching===!1||!j.isBatchedMesh&&Ft.batching===!0||j.isBatchedMesh&&Ft.batchingColor===!0&&j._colorsTexture===null||j.isBatchedMesh&&Ft.batchingColor===!1&&j._colorsTexture!==null||j.isInstancedMesh&&Ft.instancing===!1||!j.isInstancedMesh&&Ft.instancing===!0||j.isSkinnedMesh&&Ft.skinning===!1||!j.isSkinnedMesh&&Ft.skinning===!0||j.isInstancedMesh&&Ft.instancingColor===!0&&j.instanceColor===null||j.isInstancedMesh&&Ft.instancingColor===!1&&j.instanceColor!==null||j.isInstancedMesh&&Ft.instancingMorph===!0&&j.morphTexture===null||j.isInstancedMesh&&Ft.instancingMorph===!1&&j.morphTexture!==null||Ft.envMap!==Gt||J.fog===!0&&Ft.fog!==Et||Ft.numClippingPlanes!==void 0&&(Ft.numClippingPlanes!==st.numPlanes||Ft.numIntersection!==st.numIntersection)||Ft.vertexAlphas!==se||Ft.vertexTangents!==_e||Ft.morphTargets!==Vt||Ft.morphNormals!==xe||Ft.morphColors!==sn||Ft.morphTargetsCount!==Tn||Ft.numLightProbeGrids!==pn(b.state.lightProbeGridArray)?ve=!0:(Ft.outputColorSpace!==At||Ft.toneMapping!==Oe)&&(ws=!0):(ve=!0,Ft.__version=J.version);let xn=Ft.currentProgram;(ve===!0||ws===!0)&&(xn=ws===!0?vi(J,H,j,At,Oe):is(J,H,j),B&&J.isNodeMaterial&&B.onUpdateProgram(J,xn,Ft));let jr=!1,ss=!1,bs=!1,fe=xn.getUniforms(),cn=Ft.uniforms;if(bt.useProgram(xn.program)&&(jr=!0,ss=!0,bs=!0),J.id!==k&&(k=J.id,ss=!0),jr||q!==C){bt.buffers.depth.getReversed()&&C.reversedDepth!==!0&&(C._reversedDepth=!0,C.updateProjectionMatrix()),fe.setValue(V,"projectionMatrix",C.projectionMatrix),fe.setValue(V,"viewMatrix",C.matrixWorldInverse);let yn=fe.map.cameraPosition;yn!==void 0&&yn.setValue(V,Nn.setFromMatrixPosition(C.matrixWorld)),ce.logarithmicDepthBuffer&&fe.setValue(V,"logDepthBufFC",2/(Math.log(C.far+1)/Math.LN2)),(J.isMeshPhongMaterial||J.isMeshToonMaterial||J.isMeshLambertMaterial||J.isMeshBasicMaterial||J.isMeshStandardMaterial||J.isShaderMaterial)&&fe.setValue(V,"isOrthographic",C.isOrthographicCamera===!0),q!==C&&(q=C,ss=!0,bs=!0)}if(Ft.needsLights&&(_n.state.sunShadowMap.length>0&&fe.setValue(V,"sunShadowMap",_n.state.sunShadowMap,Jt),_n.state.directionalShadowMap.length>0&&fe.setValue(V,"directionalShadowMap",_n.state.directionalShadowMap,Jt),_n.state.spotShadowMap.length>0&&fe.setValue(V,"spotShadowMap",_n.state.spotShadowMap,Jt),_n.state.pointShadowMap.length>0&&fe.setValue(V,"pointShadowMap",_n.state.pointShadowMap,Jt)),j.isSkinnedMesh){fe.setOptional(V,j,"bindMatrix"),fe.setOptional(V,j,"bindMatrixInverse");let Fe=j.skeleton;Fe&&(Fe.boneTexture===null&&Fe.computeBoneTexture(),fe.setValue(V,"boneTexture",Fe.boneTexture,Jt))}j.isBatchedMesh&&(fe.setOptional(V,j,"batchingTexture"),fe.setValue(V,"batchingTexture",j._matricesTexture,Jt),fe.setOptional(V,j,"batchingIdTexture"),fe.setValue(V,"batchingIdTexture",j._indirectTexture,Jt),fe.setOptional(V,j,"batchingColorTexture"),j._colorsTexture!==null&&fe.setValue(V,"batchingColorTexture",j._colorsTexture,Jt));let si=tt.morphAttributes;if((si.position!==void 0||si.normal!==void 0||si.color!==void 0)&&rt.update(j,tt,xn),(ss||Ft.receiveShadow!==j.receiveShadow)&&(Ft.receiveShadow=j.receiveShadow,fe.setValue(V,"receiveShadow",j.receiveShadow)),(J.isMeshStandardMaterial||J.isMeshLambertMaterial||J.isMeshPhongMaterial)&&J.envMap===null&&H.environment!==null&&(cn.envMapIntensity.value=H.environmentIntensity),cn.dfgLUT!==void 0&&(cn.dfgLUT.value=zb()),ss){if(fe.setValue(V,"toneMappingExposure",P.toneMappingExposure),Ft.needsLights&&Zr(cn,bs),Et&&J.fog===!0&&_t.refreshFogUniforms(cn,Et),_t.refreshMaterialUniforms(cn,J,wt,Ct,b.state.transmissionRenderTarget[C.id]),Ft.needsLights&&Ft.numLightProbeGrids>0){let Fe=v,yn=0;for(let Jn of b.state.lightProbeGridArray)Jn.texture!==null&&(Fe.textures[yn]=Jn.texture,Fe.min[yn]=Jn.boundingBox.min,Fe.max[yn]=Jn.boundingBox.max,Fe.resolution[yn]=Jn.resolution,yn++);for(let Jn in Fe)Fe[Jn].length=yn;cn.probesSH.value=Fe.textures,cn.probesMin.value=Fe.min,cn.probesMax.value=Fe.max,cn.probesResolution.value=Fe.resolution}Xo.upload(V,Xs(Ft),cn,Jt)}if(J.isShaderMaterial&&J.uniformsNeedUpdate===!0&&(Xo.upload(V,Xs(Ft),cn,Jt),J.uniformsNeedUpdate=!1),J.isSpriteMaterial&&fe.setValue(V,"center",j.center),fe.setValue(V,"modelViewMatrix",j.modelViewMatrix),fe.setValue(V,"normalMatrix",j.normalMatrix),fe.setValue(V,"modelMatrix",j.matrixWorld),J.uniformsGroups!==void 0){let Fe=J.uniformsGroups;for(let yn=0,Jn=Fe.length;yn<Jn;yn++){let Ul=Fe[yn];qt.update(Ul,xn),qt.bind(Ul,xn)}}return xn}function Zr(C,H){C.ambientLightColor.needsUpdate=H,C.lightProbe.needsUpdate=H,C.sunLights.needsUpdate=H,C.sunLightShadows.needsUpdate=H,C.directionalLights.needsUpdate=H,C.directionalLightShadows.needsUpdate=H,C.pointLights.needsUpdate=H,C.pointLightShadows.needsUpdate=H,C.spotLights.needsUpdate=H,C.spotLightShadows.needsUpdate=H,C.rectAreaLights.needsUpdate=H,C.hemisphereLights.needsUpdate=H}function Ys(C){return C.isMeshLambertMaterial||C.isMeshToonMaterial||C.isMeshPhongMaterial||C.isMeshStandardMaterial||C.isShadowMaterial||C.isShaderMaterial&&C.lights===!0}this.getActiveCubeFace=function(){return Z},this.getActiveMipmapLevel=function(){return W},this.getRenderTarget=function(){return at},this.setRenderTargetTextures=function(C,H,tt){let J=Ht.get(C);J.__autoAllocateDepthBuffer=C.resolveDepthBuffer===!1,J.__autoAllocateDepthBuffer===!1&&(J.__useRenderToTexture=!1),Ht.get(C.texture).__webglTexture=H,Ht.get(C.depthTexture).__webglTexture=J.__autoAllocateDepthBuffer?void 0:tt,J.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(C,H){let tt=Ht.get(C);tt.__webglFramebuffer=H,tt.__useDefaultFramebuffer=H===void 0},this.setRenderTarget=function(C,H=0,tt=0){at=C,Z=H,W=tt;let J=null,j=!1,Et=!1;if(C){let At=Ht.get(C);if(At.__useDefaultFramebuffer!==void 0){bt.bindFramebuffer(V.FRAMEBUFFER,At.__webglFramebuffer),Q.copy(C.viewport),lt.copy(C.scissor),ht=C.scissorTest,bt.viewport(Q),bt.scissor(lt),bt.setScissorTest(ht),k=-1;return}else if(At.__webglFramebuffer===void 0)Jt.setupRenderTarget(C);else if(At.__hasExternalTextures)Jt.rebindTextures(C,Ht.get(C.texture).__webglTexture,Ht.get(C.depthTexture).__webglTexture);else if(C.depthBuffer){let se=C.depthTexture;if(At.__boundDepthTexture!==se){if(se!==null&&Ht.has(se)&&(C.width!==se.image.width||C.height!==se.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Jt.setupDepthRenderbuffer(C)}}let Nt=C.texture;(Nt.isData3DTexture||Nt.isDataArrayTexture||Nt.isCompressedArrayTexture)&&(Et=!0);let Gt=Ht.get(C).__webglFramebuffer;C.isWebGLCubeRenderTarget?(Array.isArray(Gt[H])?J=Gt[H][tt]:J=Gt[H],j=!0):C.samples>0&&Jt.useMultisampledRTT(C)===!1?J=Ht.get(C).__webglMultisampledFramebuffer:Array.isArray(Gt)?J=Gt[tt]:J=Gt,Q.copy(C.viewport),lt.copy(C.scissor),ht=C.scissorTest}else Q.copy(Yt).multiplyScalar(wt).floor(),lt.copy(ge).multiplyScalar(wt).floor(),ht=de;if(tt!==0&&(J=G),bt.bindFramebuffer(V.FRAMEBUFFER,J)&&bt.drawBuffers(C,J),bt.viewport(Q),bt.scissor(lt),bt.setScissorTest(ht),j){let At=Ht.get(C.texture);V.framebufferTexture2D(V.FRAMEBUFFER,V.COLOR_ATTACHMENT0,V.TEXTURE_CUBE_MAP_POSITIVE_X+H,At.__webglTexture,tt)}else if(Et){let At=H;for(let Nt=0;Nt<C.textures.length;Nt++){let Gt=Ht.get(C.textures[Nt]);V.framebufferTextureLayer(V.FRAMEBUFFER,V.COLOR_ATTACHMENT0+Nt,Gt.__webglTexture,tt,At)}}else if(C!==null&&tt!==0){let At=Ht.get(C.texture);V.framebufferTexture2D(V.FRAMEBUFFER,V.COLOR_ATTACHMENT0,V.TEXTURE_2D,At.__webglTexture,tt)}k=-1};function Jr(C){let H=Ht.get(C);return(H.__readFormat!==C.format||H.__readType!==C.type)&&(H.__readFormat=C.format,H.__readType=C.type,H.__formatReadable=ce.textureFormatReadable(C.format),H.__typeReadable=ce.textureTypeReadable(C.type)),H}this.readRenderTargetPixels=function(C,H,tt,J,j,Et,Dt,At=0){if(!(C&&C.isWebGLRenderTarget)){te("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Nt=Ht.get(C).__webglFramebuffer;if(C.isWebGLCubeRenderTarget&&Dt!==void 0&&(Nt=Nt[Dt],Array.isArray(Nt)&&(Nt=Nt[0])),Nt){bt.bindFramebuffer(V.FRAMEBUFFER,Nt);try{let Gt=C.textures[At],se=Gt.format,_e=Gt.type;C.textures.length>1&&V.readBuffer(V.COLOR_ATTACHMENT0+At);let Vt=Jr(Gt);if(Vt.__formatReadable===!1){te("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(Vt.__typeReadable===!1){te("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}H>=0&&H<=C.width-J&&tt>=0&&tt<=C.height-j&&V.readPixels(H,tt,J,j,gt.convert(se),gt.convert(_e),Et)}finally{let Gt=at!==null?Ht.get(at).__webglFramebuffer:null;bt.bindFramebuffer(V.FRAMEBUFFER,Gt)}}},this.readRenderTargetPixelsAsync=async function(C,H,tt,J,j,Et,Dt,At=0){if(!(C&&C.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Nt=Ht.get(C).__webglFramebuffer;if(C.isWebGLCubeRenderTarget&&Dt!==void 0&&(Nt=Nt[Dt],Array.isArray(Nt)&&(Nt=Nt[0])),Nt)if(H>=0&&H<=C.width-J&&tt>=0&&tt<=C.height-j){bt.bindFramebuffer(V.FRAMEBUFFER,Nt);let Gt=C.textures[At],se=Gt.format,_e=Gt.type;C.textures.length>1&&V.readBuffer(V.COLOR_ATTACHMENT0+At);let Vt=Jr(Gt);if(Vt.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(Vt.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let xe=V.createBuffer();V.bindBuffer(V.PIXEL_PACK_BUFFER,xe),V.bufferData(V.PIXEL_PACK_BUFFER,Et.byteLength,V.STREAM_READ),V.readPixels(H,tt,J,j,gt.convert(se),gt.convert(_e),0),V.bindBuffer(V.PIXEL_PACK_BUFFER,null);let sn=at!==null?Ht.get(at).__webglFramebuffer:null;bt.bindFramebuffer(V.FRAMEBUFFER,sn);let Oe=V.fenceSync(V.SYNC_GPU_COMMANDS_COMPLETE,0);return V.flush(),await pg(V,Oe,4),V.bindBuffer(V.PIXEL_PACK_BUFFER,xe),V.getBufferSubData(V.PIXEL_PACK_BUFFER,0,Et),V.bindBuffer(V.PIXEL_PACK_BUFFER,null),V.deleteBuffer(xe),V.deleteSync(Oe),Et}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(C,H=null,tt=0){let J=Math.pow(2,-tt),j=Math.floor(C.image.width*J),Et=Math.floor(C.image.height*J),Dt=H!==null?H.x:0,At=H!==null?H.y:0;Jt.setTexture2D(C,0),V.copyTexSubImage2D(V.TEXTURE_2D,tt,0,0,Dt,At,j,Et),bt.unbindTexture()},this.copyTextureToTexture=function(C,H,tt=null,J=null,j=0,Et=0){let Dt,At,Nt,Gt,se,_e,Vt,xe,sn,Oe=C.isCompressedTexture?C.mipmaps[Et]:C.image;if(tt!==null)Dt=tt.max.x-tt.min.x,At=tt.max.y-tt.min.y,Nt=tt.isBox3?tt.max.z-tt.min.z:1,Gt=tt.min.x,se=tt.min.y,_e=tt.isBox3?tt.min.z:0;else{let fe=Math.pow(2,-j);Dt=Math.floor(Oe.width*fe),At=Math.floor(Oe.height*fe),C.isDataArrayTexture?Nt=Oe.depth:C.isData3DTexture?Nt=Math.floor(Oe.depth*fe):Nt=1,Gt=0,se=0,_e=0}J!==null?(Vt=J.x,xe=J.y,sn=J.z):(Vt=0,xe=0,sn=0);let Ue=gt.convert(H.format),Tn=gt.convert(H.type),Ft;H.isData3DTexture?(Jt.setTexture3D(H,0),Ft=V.TEXTURE_3D):H.isDataArrayTexture||H.isCompressedArrayTexture?(Jt.setTexture2DArray(H,0),Ft=V.TEXTURE_2D_ARRAY):(Jt.setTexture2D(H,0),Ft=V.TEXTURE_2D),bt.activeTexture(V.TEXTURE0),bt.pixelStorei(V.UNPACK_FLIP_Y_WEBGL,H.flipY),bt.pixelStorei(V.UNPACK_PREMULTIPLY_ALPHA_WEBGL,H.premultiplyAlpha),bt.pixelStorei(V.UNPACK_ALIGNMENT,H.unpackAlignment);let _n=bt.getParameter(V.UNPACK_ROW_LENGTH),ve=bt.getParameter(V.UNPACK_IMAGE_HEIGHT),ws=bt.getParameter(V.UNPACK_SKIP_PIXELS),xn=bt.getParameter(V.UNPACK_SKIP_ROWS),jr=bt.getParameter(V.UNPACK_SKIP_IMAGES);bt.pixelStorei(V.UNPACK_ROW_LENGTH,Oe.width),bt.pixelStorei(V.UNPACK_IMAGE_HEIGHT,Oe.height),bt.pixelStorei(V.UNPACK_SKIP_PIXELS,Gt),bt.pixelStorei(V.UNPACK_SKIP_ROWS,se),bt.pixelStorei(V.UNPACK_SKIP_IMAGES,_e);let ss=C.isDataArrayTexture||C.isData3DTexture,bs=H.isDataArrayTexture||H.isData3DTexture;if(C.isDepthTexture){let fe=Ht.get(C),cn=Ht.get(H),si=Ht.get(fe.__renderTarget),Fe=Ht.get(cn.__renderTarget);bt.bindFramebuffer(V.READ_FRAMEBUFFER,si.__webglFramebuffer),bt.bindFramebuffer(V.DRAW_FRAMEBUFFER,Fe.__webglFramebuffer);for(let yn=0;yn<Nt;yn++)ss&&(V.framebufferTextureLayer(V.READ_FRAMEBUFFER,V.COLOR_ATTACHMENT0,Ht.get(C).__webglTexture,j,_e+yn),V.framebufferTextureLayer(V.DRAW_FRAMEBUFFER,V.COLOR_ATTACHMENT0,Ht.get(H).__webglTexture,Et,sn+yn)),V.blitFramebuffer(Gt,se,Gt+Dt,se+At,Vt,xe,Vt+Dt,xe+At,V.DEPTH_BUFFER_BIT,V.NEAREST);bt.bindFramebuffer(V.READ_FRAMEBUFFER,null),bt.bindFramebuffer(V.DRAW_FRAMEBUFFER,null)}else if(j!==0||C.isRenderTargetTexture||Ht.has(C)){let fe=Ht.get(C),cn=Ht.get(H);bt.bindFramebuffer(V.READ_FRAMEBUFFER,D),bt.bindFramebuffer(V.DRAW_FRAMEBUFFER,X);for(let si=0;si<Nt;si++)ss?V.framebufferTextureLayer(V.READ_FRAMEBUFFER,V.COLOR_ATTACHMENT0,fe.__webglTexture,j,_e+si):V.framebufferTexture2D(V.READ_FRAMEBUFFER,V.COLOR_ATTACHMENT0,V.TEXTURE_2D,fe.__webglTexture,j),bs?V.framebufferTextureLayer(V.DRAW_FRAMEBUFFER,V.COLOR_ATTACHMENT0,cn.__webglTexture,Et,sn+si):V.framebufferTexture2D(V.DRAW_FRAMEBUFFER,V.COLOR_ATTACHMENT0,V.TEXTURE_2D,cn.__webglTexture,Et),j!==0?V.blitFramebuffer(Gt,se,Gt+Dt,se+At,Vt,xe,Vt+Dt,xe+At,V.COLOR_BUFFER_BIT,V.NEAREST):bs?V.copyTexSubImage3D(Ft,Et,Vt,xe,sn+si,Gt,se,Dt,At):V.copyTexSubImage2D(Ft,Et,Vt,xe,Gt,se,Dt,At);bt.bindFramebuffer(V.READ_FRAMEBUFFER,null),bt.bindFramebuffer(V.DRAW_FRAMEBUFFER,null)}else bs?C.isDataTexture||C.isData3DTexture?V.texSubImage3D(Ft,Et,Vt,xe,sn,Dt,At,Nt,Ue,Tn,Oe.data):H.isCompressedArrayTexture?V.compressedTexSubImage3D(Ft,Et,Vt,xe,sn,Dt,At,Nt,Ue,Oe.data):V.texSubImage3D(Ft,Et,Vt,xe,sn,Dt,At,Nt,Ue,Tn,Oe):C.isDataTexture?V.texSubImage2D(V.TEXTURE_2D,Et,Vt,xe,Dt,At,Ue,Tn,Oe.data):C.isCompressedTexture?V.compressedTexSubImage2D(V.TEXTURE_2D,Et,Vt,xe,Oe.width,Oe.height,Ue,Oe.data):V.texSubImage2D(V.TEXTURE_2D,Et,Vt,xe,Dt,At,Ue,Tn,Oe);bt.pixelStorei(V.UNPACK_ROW_LENGTH,_n),bt.pixelStorei(V.UNPACK_IMAGE_HEIGHT,ve),bt.pixelStorei(V.UNPACK_SKIP_PIXELS,ws),bt.pixelStorei(V.UNPACK_SKIP_ROWS,xn),bt.pixelStorei(V.UNPACK_SKIP_IMAGES,jr),Et===0&&H.generateMipmaps===!0&&H.mipmapsAutoUpdate===!0&&V.generateMipmap(Ft),bt.unbindTexture()},this.initRenderTarget=function(C){Ht.get(C).__webglFramebuffer===void 0&&Jt.setupRenderTarget(C)},this.initTexture=function(C){C.isCubeTexture?Jt.setTextureCube(C,0):C.isData3DTexture?Jt.setTexture3D(C,0):C.isDataArrayTexture||C.isCompressedArrayTexture?Jt.setTexture2DArray(C,0):Jt.setTexture2D(C,0),bt.unbindTexture()},this.resetState=function(){Z=0,W=0,at=null,bt.reset(),Mt.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return Oi}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(t){this._outputColorSpace=t;let e=this.getContext();e.drawingBufferColorSpace=Se._getDrawingBufferColorSpace(t),e.unpackColorSpace=Se._getUnpackColorSpace()}};var Vb={"<f4":Float32Array,"<i4":Int32Array,"<u2":Uint16Array,"|u1":Uint8Array};function Ki(i){let t=new DataView(i).getUint32(0,!0),e=JSON.parse(new TextDecoder().decode(new Uint8Array(i,4,t))),n={};for(let[s,[r,o,a]]of Object.entries(e.arrays)){let l=a.reduce((c,d)=>c*d,1);n[s]=new Vb[r](i,4+t+o,l)}return e.arrays=n,e}var Kg=new URLSearchParams(location.search).get("token")??"",Gb=new Set(["log"]),Vh=class{constructor(t,e,n){Object.assign(this,{receive:t,report:e,onLink:n}),this.wants={},this.pending=new Map,this.number=0,this.delay=500,this.bytes=this.packets=0,document.addEventListener("visibilitychange",()=>document.hidden?this.close():this.open())}open(){if(this.socket||document.hidden||window.simkitFile)return;let t=new WebSocket(new URL(`ws?token=${encodeURIComponent(Kg)}`,location.href.replace(/^http/,"ws")));this.socket=t,t.binaryType="arraybuffer",t.onopen=()=>{this.delay=500,this.sendWants(),this.onLink(!0)},t.onmessage=e=>this.take(e.data),t.onclose=()=>{if(this.socket===t){this.socket=null;for(let{reject:e}of this.pending.values())e(new Error("the connection has ended"));this.pending.clear(),this.onLink(!1),document.hidden||setTimeout(()=>this.open(),this.delay=Math.min(2*this.delay,5e3))}}}close(){let t=this.socket;this.socket=null,t?.close(),t&&this.onLink(!1)}take(t){if(typeof t!="string"){this.bytes+=t.byteLength,this.packets+=1,this.receive(Ki(t));return}let e=JSON.parse(t),n=this.pending.get(e.id);this.pending.delete(e.id),n&&"ok"in e?n.resolve(e.ok):n?n.reject(new Error(e.error)):e.error&&this.report(e.error)}ask(t,e={}){if(this.player&&!Gb.has(t))return this.player.ask(t,e);if(this.socket?.readyState!==WebSocket.OPEN)return Promise.reject(new Error("there is no connection"));let n=++this.number;return this.socket.send(JSON.stringify({...e,do:t,id:n})),new Promise((s,r)=>this.pending.set(n,{resolve:s,reject:r}))}send(t,e={}){return this.ask(t,e).catch(n=>this.report(n.message))}want(t,e){JSON.stringify(this.wants[t]??null)!==JSON.stringify(e)&&(e===null?delete this.wants[t]:this.wants[t]=e,this.sendWants())}sendWants(){this.socket?.readyState===WebSocket.OPEN&&this.socket.send(JSON.stringify({do:"want",streams:this.wants}))}async loadScene(){return window.simkitFile?Ki(window.simkitFile.scene):Ki(await(await this.fetch("scene")).arrayBuffer())}async fetch(t){let e=await fetch(`${t}?token=${encodeURIComponent(Kg)}`);if(!e.ok)throw new Error(await e.text());return e}};var Qg=new en,Gh=new R,qo=class extends nl{constructor(){super(),this.isLineSegmentsGeometry=!0,this.type="LineSegmentsGeometry";let t=[-1,2,0,1,2,0,-1,1,0,1,1,0,-1,0,0,1,0,0,-1,-1,0,1,-1,0],e=[-1,2,1,2,-1,1,1,1,-1,-1,1,-1,-1,-2,1,-2],n=[0,2,1,2,3,1,2,4,3,4,5,3,4,6,5,6,7,5];this.setIndex(n),this.setAttribute("position",new ie(t,3)),this.setAttribute("uv",new ie(e,2))}applyMatrix4(t){let e=this.attributes.instanceStart,n=this.attributes.instanceEnd;return e!==void 0&&(e.applyMatrix4(t),n.applyMatrix4(t),e.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this}setPositions(t){let e;t instanceof Float32Array?e=t:Array.isArray(t)&&(e=new Float32Array(t));let n=new cr(e,6,1);return this.setAttribute("instanceStart",new Ei(n,3,0)),this.setAttribute("instanceEnd",new Ei(n,3,3)),this.instanceCount=this.attributes.instanceStart.count,this.computeBoundingBox(),this.computeBoundingSphere(),this}setColors(t){let e;t instanceof Float32Array?e=t:Array.isArray(t)&&(e=new Float32Array(t));let n=new cr(e,6,1);return this.setAttribute("instanceColorStart",new Ei(n,3,0)),this.setAttribute("instanceColorEnd",new Ei(n,3,3)),this}fromWireframeGeometry(t){return this.setPositions(t.attributes.position.array),this}fromEdgesGeometry(t){return this.setPositions(t.attributes.position.array),this}fromMesh(t){return this.fromWireframeGeometry(new $a(t.geometry)),this}fromLineSegments(t){let e=t.geometry;return this.setPositions(e.attributes.position.array),this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new en);let t=this.attributes.instanceStart,e=this.attributes.instanceEnd;t!==void 0&&e!==void 0&&(this.boundingBox.setFromBufferAttribute(t),Qg.setFromBufferAttribute(e),this.boundingBox.union(Qg))}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new mi),this.boundingBox===null&&this.computeBoundingBox();let t=this.attributes.instanceStart,e=this.attributes.instanceEnd;if(t!==void 0&&e!==void 0){let n=this.boundingSphere.center;this.boundingBox.getCenter(n);let s=0;for(let r=0,o=t.count;r<o;r++)Gh.fromBufferAttribute(t,r),s=Math.max(s,n.distanceToSquared(Gh)),Gh.fromBufferAttribute(e,r),s=Math.max(s,n.distanceToSquared(Gh));this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&console.error("THREE.LineSegmentsGeometry.computeBoundingSphere(): Computed radius is NaN. The instanced position data is likely to have NaN values.",this)}}toJSON(){}};It.line={worldUnits:{value:1},linewidth:{value:1},resolution:{value:new Bt},dashOffset:{value:0},dashScale:{value:1},dashSize:{value:1},gapSize:{value:1}};fi.line={uniforms:ml.merge([It.common,It.fog,It.line]),vertexShader:`
		#include <common>
		#include <color_pars_vertex>
		#include <fog_pars_vertex>
		#include <logdepthbuf_pars_vertex>
		#include <clipping_planes_pars_vertex>

		uniform float linewidth;
		uniform vec2 resolution;

		attribute vec3 instanceStart;
		attribute vec3 instanceEnd;

		attribute vec3 instanceColorStart;
		attribute vec3 instanceColorEnd;

		#ifdef WORLD_UNITS

			varying vec4 worldPos;
			varying vec3 worldStart;
			varying vec3 worldEnd;

			#ifdef USE_DASH

				varying vec2 vUv;

			#endif

		#else

			varying vec2 vUv;

		#endif

		#ifdef USE_DASH

			uniform float dashScale;
			attribute float instanceDistanceStart;
			attribute float instanceDistanceEnd;
			varying float vLineDistance;

		#endif

		float trimSegmentAlpha( const in vec4 start, const in vec4 end ) {

			// compute the interpolation factor needed to trim the segment so it terminates
			// between the camera plane and the near plane

			// conservative estimate of the near plane
			float a = projectionMatrix[ 2 ][ 2 ]; // 3nd entry in 3th column
			float b = projectionMatrix[ 3 ][ 2 ]; // 3nd entry in 4th column

			// we need different nearEstimate formula for reversed and default depth buffer
			// a is positive with a reversed depth buffer so it can be used for controlling the code flow
			float nearEstimate = ( a > 0.0 ) ? ( - b / ( a + 1.0 ) ) : ( - 0.5 * b / a );

			return ( nearEstimate - start.z ) / ( end.z - start.z );

		}

		void main() {

			#ifdef USE_COLOR

				vColor.xyz = ( position.y < 0.5 ) ? instanceColorStart : instanceColorEnd;

			#endif

			float aspect = resolution.x / resolution.y;

			// camera space
			vec4 start = modelViewMatrix * vec4( instanceStart, 1.0 );
			vec4 end = modelViewMatrix * vec4( instanceEnd, 1.0 );

			#ifdef USE_DASH

				float lineDistanceStart = dashScale * instanceDistanceStart;
				float lineDistanceEnd = dashScale * instanceDistanceEnd;

			#endif

			#ifdef WORLD_UNITS

				worldStart = start.xyz;
				worldEnd = end.xyz;

			#else

				vUv = uv;

			#endif

			// special case for perspective projection, and segments that terminate either in, or behind, the camera plane
			// clearly the gpu firmware has a way of addressing this issue when projecting into ndc space
			// but we need to perform ndc-space calculations in the shader, so we must address this issue directly
			// perhaps there is a more elegant solution -- WestLangley

			bool perspective = ( projectionMatrix[ 2 ][ 3 ] == - 1.0 ); // 4th entry in the 3rd column

			if ( perspective ) {

				if ( start.z < 0.0 && end.z >= 0.0 ) {

					float alpha = trimSegmentAlpha( start, end );
					end.xyz = mix( start.xyz, end.xyz, alpha );

					#ifdef USE_DASH

						lineDistanceEnd = mix( lineDistanceStart, lineDistanceEnd, alpha );

					#endif

				} else if ( end.z < 0.0 && start.z >= 0.0 ) {

					float alpha = trimSegmentAlpha( end, start );
					start.xyz = mix( end.xyz, start.xyz, alpha );

					#ifdef USE_DASH

						lineDistanceStart = mix( lineDistanceEnd, lineDistanceStart, alpha );

					#endif

				}

			}

			#ifdef USE_DASH

				vLineDistance = ( position.y < 0.5 ) ? lineDistanceStart : lineDistanceEnd;
				vUv = uv;

			#endif

			// clip space
			vec4 clipStart = projectionMatrix * start;
			vec4 clipEnd = projectionMatrix * end;

			// ndc space
			vec3 ndcStart = clipStart.xyz / clipStart.w;
			vec3 ndcEnd = clipEnd.xyz / clipEnd.w;

			// direction
			vec2 dir = ndcEnd.xy - ndcStart.xy;

			// account for clip-space aspect ratio
			dir.x *= aspect;
			dir = normalize( dir );

			#ifdef WORLD_UNITS

				vec3 worldDir = normalize( end.xyz - start.xyz );
				vec3 tmpFwd = perspective ? normalize( mix( start.xyz, end.xyz, 0.5 ) ) : vec3( 0.0, 0.0, - 1.0 );
				vec3 worldUp = normalize( cross( worldDir, tmpFwd ) );
				vec3 worldFwd = cross( worldDir, worldUp );
				worldPos = position.y < 0.5 ? start: end;

				// height offset
				float hw = linewidth * 0.5;
				worldPos.xyz += position.x < 0.0 ? hw * worldUp : - hw * worldUp;

				// don't extend the line if we're rendering dashes because we
				// won't be rendering the endcaps
				#ifndef USE_DASH

					// cap extension
					worldPos.xyz += position.y < 0.5 ? - hw * worldDir : hw * worldDir;

					// add width to the box
					worldPos.xyz += worldFwd * hw;

					// endcaps
					if ( position.y > 1.0 || position.y < 0.0 ) {

						worldPos.xyz -= worldFwd * 2.0 * hw;

					}

				#endif

				// project the worldpos
				vec4 clip = projectionMatrix * worldPos;

				// shift the depth of the projected points so the line
				// segments overlap neatly
				vec3 clipPose = ( position.y < 0.5 ) ? ndcStart : ndcEnd;

				// only shift the depth of vertices in front of the camera (#35137)
				if ( clip.w > 0.0 ) clip.z = clipPose.z * clip.w;

			#else

				vec2 offset = vec2( dir.y, - dir.x );
				// undo aspect ratio adjustment
				dir.x /= aspect;
				offset.x /= aspect;

				// sign flip
				if ( position.x < 0.0 ) offset *= - 1.0;

				// endcaps
				if ( position.y < 0.0 ) {

					offset += - dir;

				} else if ( position.y > 1.0 ) {

					offset += dir;

				}

				// adjust for linewidth
				offset *= linewidth;

				// adjust for clip-space to screen-space conversion // maybe resolution should be based on viewport ...
				offset /= resolution.y;

				// select end
				vec4 clip = ( position.y < 0.5 ) ? clipStart : clipEnd;

				// back to clip space
				offset *= clip.w;

				clip.xy += offset;

			#endif

			gl_Position = clip;

			vec4 mvPosition = ( position.y < 0.5 ) ? start : end; // this is an approximation

			#include <logdepthbuf_vertex>
			#include <clipping_planes_vertex>
			#include <fog_vertex>

		}
		`,fragmentShader:`
		uniform vec3 diffuse;
		uniform float opacity;
		uniform float linewidth;

		#ifdef USE_DASH

			uniform float dashOffset;
			uniform float dashSize;
			uniform float gapSize;

		#endif

		varying float vLineDistance;

		#ifdef WORLD_UNITS

			varying vec4 worldPos;
			varying vec3 worldStart;
			varying vec3 worldEnd;

			#ifdef USE_DASH

				varying vec2 vUv;

			#endif

		#else

			varying vec2 vUv;

		#endif

		#include <common>
		#include <color_pars_fragment>
		#include <fog_pars_fragment>
		#include <logdepthbuf_pars_fragment>
		#include <clipping_planes_pars_fragment>

		vec2 closestLineToLine(vec3 p1, vec3 p2, vec3 p3, vec3 p4) {

			float mua;
			float mub;

			vec3 p13 = p1 - p3;
			vec3 p43 = p4 - p3;

			vec3 p21 = p2 - p1;

			float d1343 = dot( p13, p43 );
			float d4321 = dot( p43, p21 );
			float d1321 = dot( p13, p21 );
			float d4343 = dot( p43, p43 );
			float d2121 = dot( p21, p21 );

			float denom = d2121 * d4343 - d4321 * d4321;

			float numer = d1343 * d4321 - d1321 * d4343;

			mua = numer / denom;
			mua = clamp( mua, 0.0, 1.0 );
			mub = ( d1343 + d4321 * ( mua ) ) / d4343;
			mub = clamp( mub, 0.0, 1.0 );

			return vec2( mua, mub );

		}

		void main() {

			float alpha = opacity;
			vec4 diffuseColor = vec4( diffuse, alpha );

			#include <clipping_planes_fragment>

			#ifdef USE_DASH

				if ( vUv.y < - 1.0 || vUv.y > 1.0 ) discard; // discard endcaps

				if ( mod( vLineDistance + dashOffset, dashSize + gapSize ) > dashSize ) discard; // todo - FIX

			#endif

			#ifdef WORLD_UNITS

				float len;

				if ( isOrthographic ) {

					// View rays are parallel to the z axis so the distance reduces to camera-space XY
					vec2 lineDir = worldEnd.xy - worldStart.xy;
					float t = clamp( dot( worldPos.xy - worldStart.xy, lineDir ) / dot( lineDir, lineDir ), 0.0, 1.0 );
					len = length( worldStart.xy + lineDir * t - worldPos.xy );

				} else {

					// Find the closest points on the view ray and the line segment
					vec3 rayEnd = normalize( worldPos.xyz ) * 1e5;
					vec3 lineDir = worldEnd - worldStart;
					vec2 params = closestLineToLine( worldStart, worldEnd, vec3( 0.0, 0.0, 0.0 ), rayEnd );

					vec3 p1 = worldStart + lineDir * params.x;
					vec3 p2 = rayEnd * params.y;
					vec3 delta = p1 - p2;
					len = length( delta );

				}

				float norm = len / linewidth;

				#ifndef USE_DASH

					#ifdef USE_ALPHA_TO_COVERAGE

						float dnorm = fwidth( norm );
						alpha = 1.0 - smoothstep( 0.5 - dnorm, 0.5 + dnorm, norm );

					#else

						if ( norm > 0.5 ) {

							discard;

						}

					#endif

				#endif

			#else

				#ifdef USE_ALPHA_TO_COVERAGE

					// artifacts appear on some hardware if a derivative is taken within a conditional
					float a = vUv.x;
					float b = ( vUv.y > 0.0 ) ? vUv.y - 1.0 : vUv.y + 1.0;
					float len2 = a * a + b * b;
					float dlen = fwidth( len2 );

					if ( abs( vUv.y ) > 1.0 ) {

						alpha = 1.0 - smoothstep( 1.0 - dlen, 1.0 + dlen, len2 );

					}

				#else

					if ( abs( vUv.y ) > 1.0 ) {

						float a = vUv.x;
						float b = ( vUv.y > 0.0 ) ? vUv.y - 1.0 : vUv.y + 1.0;
						float len2 = a * a + b * b;

						if ( len2 > 1.0 ) discard;

					}

				#endif

			#endif

			#include <logdepthbuf_fragment>
			#include <color_fragment>

			gl_FragColor = vec4( diffuseColor.rgb, alpha );

			#include <tonemapping_fragment>
			#include <colorspace_fragment>
			#include <fog_fragment>
			#include <premultiplied_alpha_fragment>

		}
		`};var $o=class extends ui{constructor(t){super({type:"LineMaterial",uniforms:ml.clone(fi.line.uniforms),vertexShader:fi.line.vertexShader,fragmentShader:fi.line.fragmentShader,clipping:!0}),this.isLineMaterial=!0,this.setValues(t)}get color(){return this.uniforms.diffuse.value}set color(t){this.uniforms.diffuse.value=t}get worldUnits(){return"WORLD_UNITS"in this.defines}set worldUnits(t){t===!0!==this.worldUnits&&(this.needsUpdate=!0),t===!0?this.defines.WORLD_UNITS="":delete this.defines.WORLD_UNITS}get linewidth(){return this.uniforms.linewidth.value}set linewidth(t){this.uniforms.linewidth&&(this.uniforms.linewidth.value=t)}get dashed(){return"USE_DASH"in this.defines}set dashed(t){t===!0!==this.dashed&&(this.needsUpdate=!0),t===!0?this.defines.USE_DASH="":delete this.defines.USE_DASH}get dashScale(){return this.uniforms.dashScale.value}set dashScale(t){this.uniforms.dashScale.value=t}get dashSize(){return this.uniforms.dashSize.value}set dashSize(t){this.uniforms.dashSize.value=t}get dashOffset(){return this.uniforms.dashOffset.value}set dashOffset(t){this.uniforms.dashOffset.value=t}get gapSize(){return this.uniforms.gapSize.value}set gapSize(t){this.uniforms.gapSize.value=t}get opacity(){return this.uniforms.opacity.value}set opacity(t){this.uniforms&&(this.uniforms.opacity.value=t)}get resolution(){return this.uniforms.resolution.value}set resolution(t){this.uniforms.resolution.value.copy(t)}get alphaToCoverage(){return"USE_ALPHA_TO_COVERAGE"in this.defines}set alphaToCoverage(t){this.defines&&(t===!0!==this.alphaToCoverage&&(this.needsUpdate=!0),t===!0?this.defines.USE_ALPHA_TO_COVERAGE="":delete this.defines.USE_ALPHA_TO_COVERAGE)}};var yf=new De,t0=new R,e0=new R,qn=new De,$n=new De,ps=new De,vf=new R,Sf=new Wt,Zn=new il,n0=new R,Hh=new en,Wh=new mi,ms=new De,gs,Fr;function i0(i,t,e){return ms.set(0,0,-t,1).applyMatrix4(i.projectionMatrix),ms.multiplyScalar(1/ms.w),ms.x=Fr/e.width,ms.y=Fr/e.height,ms.applyMatrix4(i.projectionMatrixInverse),ms.multiplyScalar(1/ms.w),Math.abs(Math.max(ms.x,ms.y))}function Hb(i,t){let e=i.matrixWorld,n=i.geometry,s=n.attributes.instanceStart,r=n.attributes.instanceEnd,o=Math.min(n.instanceCount,s.count);for(let a=0,l=o;a<l;a++){Zn.start.fromBufferAttribute(s,a),Zn.end.fromBufferAttribute(r,a),Zn.applyMatrix4(e);let c=new R,d=new R;gs.distanceSqToSegment(Zn.start,Zn.end,d,c),d.distanceTo(c)<Fr*.5&&t.push({point:d,pointOnLine:c,distance:gs.origin.distanceTo(d),object:i,face:null,faceIndex:a,uv:null,uv1:null})}}function Wb(i,t,e){let n=t.projectionMatrix,r=i.material.resolution,o=i.matrixWorld,a=i.geometry,l=a.attributes.instanceStart,c=a.attributes.instanceEnd,d=Math.min(a.instanceCount,l.count),h=-t.near;gs.at(1,ps),ps.w=1,ps.applyMatrix4(t.matrixWorldInverse),ps.applyMatrix4(n),ps.multiplyScalar(1/ps.w),ps.x*=r.x/2,ps.y*=r.y/2,ps.z=0,vf.copy(ps),Sf.multiplyMatrices(t.matrixWorldInverse,o);for(let u=0,f=d;u<f;u++){if(qn.fromBufferAttribute(l,u),$n.fromBufferAttribute(c,u),qn.w=1,$n.w=1,qn.applyMatrix4(Sf),$n.applyMatrix4(Sf),qn.z>h&&$n.z>h)continue;if(qn.z>h){let T=qn.z-$n.z,v=(qn.z-h)/T;qn.lerp($n,v)}else if($n.z>h){let T=$n.z-qn.z,v=($n.z-h)/T;$n.lerp(qn,v)}qn.applyMatrix4(n),$n.applyMatrix4(n),qn.multiplyScalar(1/qn.w),$n.multiplyScalar(1/$n.w),qn.x*=r.x/2,qn.y*=r.y/2,$n.x*=r.x/2,$n.y*=r.y/2,Zn.start.copy(qn),Zn.start.z=0,Zn.end.copy($n),Zn.end.z=0;let _=Zn.closestPointToPointParameter(vf,!0);Zn.at(_,n0);let m=pl.lerp(qn.z,$n.z,_),g=m>=-1&&m<=1,y=vf.distanceTo(n0)<Fr*.5;if(g&&y){Zn.start.fromBufferAttribute(l,u),Zn.end.fromBufferAttribute(c,u),Zn.start.applyMatrix4(o),Zn.end.applyMatrix4(o);let T=new R,v=new R;gs.distanceSqToSegment(Zn.start,Zn.end,v,T),e.push({point:v,pointOnLine:T,distance:gs.origin.distanceTo(v),object:i,face:null,faceIndex:u,uv:null,uv1:null})}}}var Xh=class extends St{constructor(t=new qo,e=new $o({color:Math.random()*16777215})){super(t,e),this.isLineSegments2=!0,this.type="LineSegments2"}computeLineDistances(){let t=this.geometry,e=t.attributes.instanceStart,n=t.attributes.instanceEnd,s=new Float32Array(2*e.count);for(let o=0,a=0,l=e.count;o<l;o++,a+=2)t0.fromBufferAttribute(e,o),e0.fromBufferAttribute(n,o),s[a]=a===0?0:s[a-1],s[a+1]=s[a]+t0.distanceTo(e0);let r=new cr(s,2,1);return t.setAttribute("instanceDistanceStart",new Ei(r,1,0)),t.setAttribute("instanceDistanceEnd",new Ei(r,1,1)),this}raycast(t,e){let n=this.material.worldUnits,s=t.camera;if(s===null&&!n&&console.error('LineSegments2: "Raycaster.camera" needs to be set in order to raycast against LineSegments2 while worldUnits is set to false.'),n===!1&&(this.material.resolution.x===0||this.material.resolution.y===0))return;let r=t.params.Line2!==void 0&&t.params.Line2.threshold||0;gs=t.ray;let o=this.matrixWorld,a=this.geometry,l=this.material;Fr=l.linewidth+r,a.boundingSphere===null&&a.computeBoundingSphere(),Wh.copy(a.boundingSphere).applyMatrix4(o);let c;if(n)c=Fr*.5;else{let h=Math.max(s.near,Wh.distanceToPoint(gs.origin));c=i0(s,h,l.resolution)}if(Wh.radius+=c,gs.intersectsSphere(Wh)===!1)return;a.boundingBox===null&&a.computeBoundingBox(),Hh.copy(a.boundingBox).applyMatrix4(o);let d;if(n)d=Fr*.5;else{let h=Math.max(s.near,Hh.distanceToPoint(gs.origin));d=i0(s,h,l.resolution)}Hh.expandByScalar(d),gs.intersectsBox(Hh)!==!1&&(n?Hb(this,e):Wb(this,s,e))}onBeforeRender(t){let e=this.material.uniforms;e&&e.resolution&&(t.getViewport(yf),this.material.uniforms.resolution.value.set(yf.z,yf.w))}};var Zo=0,Mf=1,s0=2,r0=3,o0=4,a0=5,l0=6,c0=7,Xb=1,h0=2,u0=new R(1,1,1),Yh=250,Yb=1e-4,qb=.5,$b=.1,Zb=1e4,Jb=.5,Bi={m:new Wt,b:new Wt,p:new R,q:new ze};function on(i,t,e){return Bi.p.fromArray(i,t),Bi.q.set(i[t+4],i[t+5],i[t+6],i[t+3]),e.compose(Bi.p,Bi.q,u0)}var d0=[];for(let i of[-1,0,1])for(let t of[-1,0,1])for(let e of[-1,0,1])(i||t||e)&&d0.push([i,t,e]);function jb(i){if(i.userData.outermost)return i.userData.outermost;let{array:t}=i.attributes.position,e=new Set;for(let[n,s,r]of d0){let o=0,a=-1/0;for(let l=0;l<t.length;l+=3){let c=n*t[l]+s*t[l+1]+r*t[l+2];c>a&&(a=c,o=l)}e.add(o)}return i.userData.outermost=[...e].flatMap(n=>[t[n],t[n+1],t[n+2]])}var qh=class{constructor(t){this.stage=t,this.root=new Cn,this.visuals=new Cn,this.collisions=new Cn,this.root.add(this.visuals),t.helpers.add(this.collisions),this.collisions.visible=!1,t.scene.add(this.root),t.onQuality.push(()=>this.chooseMaterials()),this.unit={[s0]:new hi(1,32,20),[o0]:new hi(1,32,20),[a0]:new rn(1,1,2,40).rotateX(Math.PI/2),[l0]:new Ye(2,2,2),[Zo]:new gi(2,2)},this.bodies=[],this.drawnFloor=null}async load(t){this.scene=t,this.arrays={...t.arrays};let{body_pose:e,moving:n}=t.arrays;this.bodies=t.bodies.map((o,a)=>on(e,7*a,new Wt)),this.moving=n,this.isMoving=new Uint8Array(t.bodies.length);for(let o of n)this.isMoving[o]=1;let s=await this.loadTextures(t);for(let o of this.textures??[])o?.dispose();let r=new Set(Object.values(this.unit));for(let o of this.geometries?.values()??[])o&&!r.has(o)&&o.dispose();this.textures=s,this.geometries=new Map,this.rebuild()}rebuild(){for(let t of[this.visuals,this.collisions])for(let e of[...t.children]){t.remove(e);for(let n of e.userData.materials??[e.material])n.dispose();e.dispose?.()}this.shapes=[],this.groupGeoms(),this.makeSkins(),this.chooseMaterials(),this.place(!0),this.findFloors(),this.stage.extent=this.stage.around.extent}chooseMaterials(){for(let t of this.visuals.children)t.material=t.userData.materials[this.stage.isFull?0:1]}groupGeoms(){let{scene:t,arrays:e}=this,n=new Set(t.undrawn),s=new Map;for(let r=0;r<e.geom_type.length;r++){if(!e.geom_shown[r])continue;let o=e.geom_group[r],a=t.owners[e.geom_owner[r]];(o===Xb||o===h0||n.has(a[0].split("::",1)[0])||n.has(a[0]))&&this.addTo(s,r,!0),o!==h0&&this.addTo(s,r,!1)}for(let{geoms:r,isVisual:o,geometry:a}of s.values())this.makeInstances(r,o,a)}addTo(t,e,n){let{arrays:s}=this,r=s.geom_rgba[4*e+3];if(n&&r<=.003)return;let[o,a]=this.geometryOf(e);if(!a)return;let l=n?[o,"v",s.geom_material[e],r.toFixed(2)].join():[o,"c"].join();t.has(l)||t.set(l,{geoms:[],isVisual:n,geometry:a}),t.get(l).geoms.push(e)}geometryOf(t){let{arrays:e}=this,n=e.geom_type[t],s=e.geom_data[t],r=e.geom_size,o=`${n}`;n===c0?o+=`:${s}`:n===Mf?o+=`:${s}`:n===r0&&(o+=`:${r[3*t].toFixed(4)},${r[3*t+1].toFixed(4)}`);let a=this.scene.materials[e.geom_material[t]];return n===Zo&&a?.texture>=0&&(o+=`:${r[3*t]},${r[3*t+1]}`),this.geometries.has(o)||this.geometries.set(o,this.makeGeometry(t,n,s,a)),[o,this.geometries.get(o)]}makeGeometry(t,e,n,s){let{arrays:r}=this,o=r.geom_size.subarray(3*t,3*t+3);if(e===r0)return new Ya(o[0],2*o[1],8,24).rotateX(Math.PI/2);if(e===Mf)return this.heightGeometry(n,s);if(e===c0){if(!r[`mesh${n}.position`])return null;let a=new pe;return a.setAttribute("position",new Le(r[`mesh${n}.position`],3)),a.setAttribute("normal",new Le(r[`mesh${n}.normal`],3)),r[`mesh${n}.uv`]&&a.setAttribute("uv",new Le(r[`mesh${n}.uv`],2)),a.setIndex(new Le(new Uint32Array(r[`mesh${n}.index`]),1)),a}if(e===Zo&&s?.texture>=0){let a=this.unit[Zo].clone(),l=a.attributes.uv,c=s.uniform?o[0]||Yh:1,d=s.uniform?o[1]||Yh:1;for(let h=0;h<l.count;h++)l.setXY(h,l.getX(h)*c*s.repeat[0],(1-l.getY(h))*d*s.repeat[1]);return a}return this.unit[e]??null}heightGeometry(t,e){let{arrays:n,scene:s}=this,r=n[`heights${t}`];if(!r)return null;let[o,a,l]=n[`heights${t}.size`],[c,d]=s.heightShapes[t],h=new gi(2*o,2*a,d-1,c-1),u=h.attributes.position;for(let p=0;p<c;p++)for(let _=0;_<d;_++)u.setZ((c-1-p)*d+_,l*r[p*d+_]);let{uv:f}=h.attributes;for(let p=0;e&&p<f.count;p++)f.setXY(p,f.getX(p)*e.repeat[0],f.getY(p)*e.repeat[1]);return h.computeVertexNormals(),h}scaleOf(t){let{arrays:e}=this,[n,s,r]=e.geom_size.subarray(3*t,3*t+3);switch(e.geom_type[t]){case l0:case o0:return new R(n,s,r);case a0:return new R(n,n,s);case s0:return new R(n,n,n);case Zo:return new R(n||Yh,s||Yh,1);default:return u0.clone()}}makeInstances(t,e,n){let{arrays:s}=this,r=t[0],o=e?this.materialsOf(s.geom_material[r],s.geom_rgba[4*r+3],!!n.attributes.uv):[new Vn({color:16747039,wireframe:!0,transparent:!0,opacity:.55})],a=new Os(n,o[0],t.length);a.frustumCulled=!1;let l=s.geom_type[r]===Zo;if(a.castShadow=e&&!l&&s.geom_rgba[4*r+3]>.5,a.receiveShadow=e,a.userData={geoms:t,isFloor:l,materials:o},l)for(let h of o)Object.assign(h,{polygonOffset:!0,polygonOffsetFactor:1,polygonOffsetUnits:1});let c=new Xt;t.forEach((h,u)=>{e&&a.setColorAt(u,c.setRGB(s.geom_rgba[4*h],s.geom_rgba[4*h+1],s.geom_rgba[4*h+2],Te))});let d=t.map(h=>on([...s.geom_pos.subarray(3*h,3*h+3),...s.geom_quat.subarray(4*h,4*h+4)],0,new Wt).scale(this.scaleOf(h)));(e?this.visuals:this.collisions).add(a),this.shapes.push({mesh:a,geoms:t,local:d,isVisual:e,isFloor:l,moves:t.some(h=>this.isMoving[s.geom_body[h]])})}materialsOf(t,e,n){let s=this.scene.materials[t],r={color:16777215,transparent:e<.995,opacity:e,depthWrite:e>.6},o=s&&this.textures[s.texture];o&&n&&(r.map=o),s?.emission>0&&(r.emissive=new Xt(16777215),r.emissiveIntensity=.5*s.emission,r.map&&(r.emissiveMap=r.map));let a=new us(r),l=s?s.shininess:.3,c=s?s.specular:.3;return r.roughness=s?.roughness>=0?s.roughness:Math.min(.95,.9-.5*l*c),r.metalness=s?.metallic>=0?s.metallic:.02,[new Za(r),a]}async loadTextures(t){let e=async(n,s)=>{let r=await createImageBitmap(new Blob([t.arrays[`texture${s}`]]));if(n.kind!=="2d")return null;let o=new Wn(r);return o.flipY=!1,o.colorSpace=Te,o.wrapS=o.wrapT=Co,o.anisotropy=this.stage.isSoftware?1:8,o.needsUpdate=!0,o};return Promise.all(t.textures.map((n,s)=>e(n,s).catch(()=>null)))}makeSkins(){let{scene:t,arrays:e}=this;this.skins=t.skins.map((n,s)=>{let r=new pe,o=e[`skin${s}.position`];r.setAttribute("position",new Le(new Float32Array(o.length),3)),r.setIndex(new Le(new Uint32Array(e[`skin${s}.index`]),1)),e[`skin${s}.uv`]&&r.setAttribute("uv",new Le(e[`skin${s}.uv`],2));let a=this.materialsOf(n.material,n.rgba[3],!!e[`skin${s}.uv`]);for(let d of a)d.color.setRGB(...n.rgba.slice(0,3),Te);let l=new St(r,a[0]);l.userData.materials=a,l.frustumCulled=!1,l.castShadow=l.receiveShadow=!0,this.visuals.add(l);let c=[...e[`skin${s}.bone_body`]].map((d,h)=>{let u=on([...e[`skin${s}.bone_pos`].subarray(3*h,3*h+3),...e[`skin${s}.bone_quat`].subarray(4*h,4*h+4)],0,new Wt);return{body:d,inverse:u.invert(),count:e[`skin${s}.bone_count`][h]}});return{mesh:l,rest:o,bones:c,vertex:e[`skin${s}.vertex`],weight:e[`skin${s}.weight`]}})}bendSkins(){let t=new R;for(let{mesh:e,rest:n,bones:s,vertex:r,weight:o}of this.skins){let a=e.geometry.attributes.position.array.fill(0),l=0;for(let{body:c,inverse:d,count:h}of s){Bi.m.multiplyMatrices(this.bodies[c],d);for(let u=0;u<h;u++,l++){let f=3*r[l];t.fromArray(n,f).applyMatrix4(Bi.m).multiplyScalar(o[l]),a[f]+=t.x,a[f+1]+=t.y,a[f+2]+=t.z}}e.geometry.attributes.position.needsUpdate=!0,e.geometry.computeVertexNormals()}}setPoses(t){t.length===7*this.moving.length&&(this.moving.forEach((e,n)=>on(t,7*n,this.bodies[e])),this.isOld=!0,!(this.drawn?.length===t.length&&this.drawn.every((e,n)=>Math.abs(e-t[n])<Yb))&&(this.drawn=t.slice(),this.stage.move()))}place(t=!1){if(!t&&!this.isOld)return;this.isOld=!1;let{geom_body:e}=this.arrays;for(let n of this.shapes)!t&&(!n.moves||!n.mesh.parent.visible)||(n.geoms.forEach((s,r)=>n.mesh.setMatrixAt(r,Bi.m.multiplyMatrices(this.bodies[e[s]],n.local[r]))),n.mesh.instanceMatrix.needsUpdate=!0,n.mesh.boundingSphere=n.mesh.boundingBox=null);this.skins.length&&this.bendSkins()}setAppearance(t){if(t.geom_rgba.length!==this.arrays.geom_rgba.length)return;let e=s=>this.arrays[s].every((r,o)=>r===t[s][o]),n=!["geom_rgba","geom_pos","geom_quat"].every(e);Object.assign(this.arrays,t),this.stage.lightArrays=this.arrays,this.stage.makeLights(),n&&this.rebuild(),this.stage.invalidate()}boxOf(t){let e=new en;for(let n of this.boxesBy((s,r)=>t(s,r)?0:null).values())e.union(n);return e}boxesByModel(){return this.boxesBy((t,e)=>e?null:this.linkOf(t).split("::",1)[0])}boxesBy(t){let e=new Map,n=new R;this.place();for(let{mesh:s,geoms:r,isVisual:o,isFloor:a}of this.shapes){if(!o)continue;let l=jb(s.geometry);r.forEach((c,d)=>{let h=t(c,a);if(h!==null){e.has(h)||e.set(h,new en),s.getMatrixAt(d,Bi.m);for(let u=0;u<l.length;u+=3)e.get(h).expandByPoint(n.fromArray(l,u).applyMatrix4(Bi.m))}})}return e}linkOf(t){return this.scene.owners[this.arrays.geom_owner[t]]?.[0]??""}pick(t,e=()=>!0){this.place();for(let{object:n,instanceId:s,point:r}of t.intersectObjects(this.visuals.children.filter(o=>o.userData.geoms),!1)){let o=n.userData.geoms[s],{isFloor:a}=n.userData;if(!(this.stage.cuts.some(l=>l.distanceToPoint(r)<0)||!e(o,a)))return{geom:o,link:this.linkOf(o),owner:this.scene.owners[this.arrays.geom_owner[o]]?.[1],point:r,isFloor:a}}return null}sight(t,e,n,s){let{geom_rgba:r}=this.arrays,o=this.pick(new di(t,e,0,n),(a,l)=>!l&&r[4*a+3]>Jb&&this.modelOf(a)!==s);return o?o.point.distanceTo(t):n}modelOf(t){return this.linkOf(t).split("::",1)[0]}findFloors(){let{arrays:t}=this,e=l=>!this.isMoving[t.geom_body[l]],n=new R,s=new R;this.floors=[],this.terrains=[];for(let{mesh:l,geoms:c,isVisual:d,isFloor:h}of this.shapes)d&&(t.geom_type[c[0]]===Mf&&this.terrains.push(l),h&&c.filter(e).forEach(u=>{l.getMatrixAt(c.indexOf(u),Bi.m),n.setFromMatrixColumn(Bi.m,2).normalize().z>.99&&this.floors.push(Bi.m.elements[14])}));if(this.floors.length||this.terrains.length)return;let r=this.boxesBy(l=>l),o=new en;for(let l of r.values())o.union(l);let a=o.getSize(new R);for(let[l,c]of r){c.getSize(s);let d=Math.min(s.x,s.y);e(l)&&Math.min(s.x/a.x,s.y/a.y)>qb&&s.z<$b*d&&this.floors.push(c.max.z)}}floorAt({x:t,y:e},n){let s=new di(new R(t,e,Zb),new R(0,0,-1)),r=[...this.floors,this.drawnFloor??1/0].filter(o=>o<=n);return r.push(...s.intersectObjects(this.terrains,!1).map(o=>o.point.z)),r.length?Math.max(...r):null}};var Kb=14,$h=48,Qb=.72,tT=new Wt,vl=new Xt,p0=new R,f0={cube:()=>new Ye(1,1,1),sphere:()=>new hi(.5,20,14),cylinder:()=>new rn(.5,.5,1,20).rotateX(Math.PI/2),cone:()=>new Uo(.5,1,20).rotateX(Math.PI/2)},wf=i=>({transparent:i<.995,opacity:i,depthWrite:i>.995}),Zh=class{constructor(t){this.app=t,this.topics=[],this.shown=new Map,this.wanted=new Set,this.unit=Object.fromEntries(Object.entries(f0).map(([e,n])=>[e,n()])),t.on("packet:displays",e=>{this.topics=e.topics,t.emit("displays")}),t.on("packet:display",e=>this.show(e)),t.stage.before.push(()=>this.place())}set(t,e){e?this.wanted.add(t):this.wanted.delete(t),this.app.player?this.app.player.showDisplays(!0):this.app.connection.want(`display:${t}`,e?{}:null),e||this.remove(t),this.app.emit("displays")}problems(t){return this.shown.get(t)?.problems??[]}handles(t){return this.shown.get(t)?.handles??[]}show(t){let e=t.kind.slice(8);if(!this.wanted.has(e))return;this.remove(e);let n=new Cn,s=(t.groups??[]).flatMap(r=>(r.handles??[]).map(o=>({...o,topic:e,body:r.body,offset:r.pose})));this.shown.set(e,{root:n,handles:s,problems:t.error?[t.error]:t.problems}),(t.groups??[]).forEach((r,o)=>n.add(this.makeGroup(t,r,`g${o}`))),this.app.stage.helpers.add(n),this.app.emit("displays"),this.app.stage.invalidate()}remove(t){let e=this.shown.get(t);if(!e)return;this.shown.delete(t),this.app.stage.helpers.remove(e.root);let n=new Set(Object.values(this.unit));e.root.traverse(s=>{s.geometry&&!n.has(s.geometry)&&s.geometry.dispose(),s.material?.map?.dispose(),s.material?.dispose(),s.isInstancedMesh&&s.dispose()}),this.app.stage.invalidate()}place(){for(let{root:t}of this.shown.values())for(let e of t.children){let n=this.app.world.bodies[e.userData.body];n&&(e.matrix.multiplyMatrices(n,e.userData.offset),e.matrixWorldNeedsUpdate=!0)}}makeGroup(t,e,n){let{arrays:s}=t,r=new Cn;r.matrixAutoUpdate=!1,r.userData={body:e.body,offset:on(e.pose,0,new Wt)};for(let o of Object.keys(f0)){let a=s[`${n}.${o}`];a&&r.add(...this.makeShapes(this.unit[o],a))}for(let[o,a]of[["lines",eT],["points",nT],["triangles",_0]])e[o].forEach((l,c)=>r.add(a(s[`${n}.${o}${c}`],s[`${n}.${o}${c}.colours`],l)));for(let o of e.texts)r.add(sT(o));for(let[o,a]of e.meshes)r.add(iT(s[`mesh${o}.corners`],s[`mesh${o}.colours`],a));return e.grids.forEach((o,a)=>r.add(oT(o,s[`${n}.grid${a}`]))),r.traverse(o=>{o.frustumCulled=!1}),r}makeShapes(t,e){let n=new Map;for(let s=0;s<e.length;s+=Kb){let r=e[s+13].toFixed(2);n.has(r)||n.set(r,[]),n.get(r).push(s)}return[...n].map(([s,r])=>{let o=new Os(t,new us({fog:!1,...wf(+s)}),r.length);return r.forEach((a,l)=>{o.setMatrixAt(l,on(e,a,tT).scale(p0.set(e[a+7],e[a+8],e[a+9]))),o.setColorAt(l,vl.setRGB(e[a+10],e[a+11],e[a+12],Te))}),o})}};function m0(i,t){let e=new Float32Array(i.length/4*t);for(let n=0,s=0;n<i.length;n+=4,s+=t)vl.setRGB(i[n]/255,i[n+1]/255,i[n+2]/255,Te),e[s]=vl.r,e[s+1]=vl.g,e[s+2]=vl.b,t===4&&(e[s+3]=i[n+3]/255);return e}function eT(i,t,e){let n=new qo;return n.setPositions(i),n.setColors(m0(t,3)),new Xh(n,new $o({linewidth:e||.01,worldUnits:!0,vertexColors:!0,fog:!1,...wf(t[3]/255)}))}function g0(i,t){let e=new pe;return e.setAttribute("position",new Le(i,3)),e.setAttribute("color",new Le(m0(t,4),4)),e}function nT(i,t,e){let n=new Us({size:e/Math.tan(22.5*Math.PI/180),vertexColors:!0,transparent:!0,fog:!1});return new sr(g0(i,t),n)}function _0(i,t){let e=!0;for(let s=3;s<t.length;s+=4)e&&=t[s]>253;let n=g0(i,t);return n.computeVertexNormals(),new St(n,new us({vertexColors:!0,side:Mn,transparent:!e,depthWrite:e,fog:!1}))}function iT(i,t,e){let n=_0(i,t);return n.matrixAutoUpdate=!1,on(e,0,n.matrix).scale(p0.set(e[7],e[8],e[9])),n.material.color.setRGB(e[10],e[11],e[12],Te),e[13]<.995&&Object.assign(n.material,wf(e[13])),n}function sT([i,t,e,n,s,r,o,a,l]){let c=document.createElement("canvas"),d=c.getContext("2d"),h=i.split(`
`),u=`${$h}px system-ui, sans-serif`;d.font=u,c.width=Math.min(2048,Math.ceil(Math.max(...h.map(m=>d.measureText(m).width),1))+8),c.height=Math.min(2048,Math.ceil(1.2*$h*h.length)),d.font=u,d.textBaseline="middle",d.textAlign="center",d.fillStyle=`rgb(${255*r} ${255*o} ${255*a})`,h.forEach((m,g)=>d.fillText(m,c.width/2,1.2*$h*(g+.5)));let f=new Ha(c);f.colorSpace=Te;let p=new Va(new Oo({map:f,transparent:!0,opacity:l,depthWrite:!1,fog:!1})),_=s/(Qb*$h);return p.position.set(t,e,n),p.scale.set(c.width*_,c.height*_,1),p.renderOrder=6,p.raycast=()=>{},p}function rT(i){let t=new Uint8Array(1024);for(let e=0;e<256;e++){let n;e===255?n=[112,137,134,255]:e>127?n=[255,Math.round(255*(e-128)/126),0,255]:e>100?n=[0,255,0,255]:i!=="costmap"?n=[0,1,2].map(()=>255-Math.round(255*e/100)).concat(255):e===0?n=[0,0,0,0]:e===100?n=[255,0,255,255]:e===99?n=[0,255,255,255]:n=[Math.round(255*e/100),0,255-Math.round(255*e/100),255],t.set(n,4*e)}return t}function oT({rows:i,columns:t,resolution:e,colours:n,pose:s},r){let o=rT(n),a=new Uint8Array(4*i*t);for(let f=0;f<r.length;f++)a.set(o.subarray(4*r[f],4*r[f]+4),4*f);let l=new Ar(a,t,i);l.colorSpace=Te,l.needsUpdate=!0;let c=t*e,d=i*e,h=new gi(c,d).translate(c/2,d/2,0),u=new St(h,new Vn({map:l,transparent:!0,opacity:.7,depthWrite:!1,side:Mn,fog:!1,polygonOffset:!0,polygonOffsetFactor:-1,polygonOffsetUnits:-2}));return u.matrixAutoUpdate=!1,on(s,0,u.matrix),u.renderOrder=n==="costmap"?1:0,u}var _s=(i,t)=>i.toFixed(t).replace(/^-(0(\.0*)?)$/,"$1");function U(i,t={},...e){let n=document.createElement(i);for(let[s,r]of Object.entries(t))s==="class"?n.className=r:s.startsWith("on")?n.addEventListener(s.slice(2),r):s.includes("-")?n.setAttribute(s,r):n[s]=r;return n.append(...e.filter(s=>s!==null)),n}var Br=matchMedia("(max-width: 900px)");function ni(i,t,...e){let n=U("details",{class:"panel",id:i,open:!Br.matches||["drive","selection"].includes(i)},U("summary",{},t),...e),s=`simkit-${Br.matches?"phone":"panel"}-${i}`;try{let r=localStorage.getItem(s);r&&(n.open=r==="open"),n.addEventListener("toggle",()=>localStorage.setItem(s,n.open?"open":"closed"))}catch{}return n}function Jo(i,t,e,n){let s=U("input",{type:"checkbox",id:i,checked:e,onchange:()=>n(s.checked)});return U("label",{class:"check"},s,t)}function Jh(i){let t=i.target.closest("input, select, textarea");return!(i.ctrlKey||i.metaKey||i.altKey)&&(!t||t.type==="checkbox"&&i.key!==" ")}function jh(i,t){try{document.cookie=`simkit-${i}=${t}; max-age=31536000; samesite=strict; path=/`}catch{}}function Kh(i){try{return document.cookie.match(new RegExp(`(?:^|; )simkit-${i}=(\\w+)`))?.[1]}catch{return}}var x0=[15026253,4630360,4094970],aT=2068479,lT=14254635,cT=60,y0=.003,hT=250,uT=150,Qh=i=>i.split("::").at(-1),mr=new Wt,bf=[["visuals","Visuals",!0],["collisions","Collisions",!1],["lidar","Lidar",!0],["path","Path driven",!0],["frusta","Sensor views",!1],["clouds","Point clouds",!1],["contacts","Contacts",!1],["frames","Frames (TF)",!1],["joints","Joint axes",!1],["inertia","Inertias",!1],["mass","Centres of mass",!1],["grid","Grid",!0],["shadows","Shadows",!0],["transparent","Transparent",!1]],dT=[[0,1,2],[1,2,0],[2,0,1]].flatMap(([i,t,e])=>[[-1,-1],[-1,1],[1,-1],[1,1]].map(([n,s])=>{let r=[0,0,0];return r[t]=n/2,r[e]=s/2,[-.5,.5].map(o=>{let a=[...r];return a[i]=o,a})})),kr=class{constructor(t,e=!1){this.geometry=new pe;let n=new Ai({vertexColors:!0,depthTest:e,transparent:!0,fog:!1});this.object=new ir(this.geometry,n),this.object.frustumCulled=!1,this.object.renderOrder=5,t.add(this.object),this.clear()}clear(){this.points=[],this.colours=[]}add(t,e,n){this.points.push(t.x,t.y,t.z,e.x,e.y,e.z);let s=fT.set(n);this.colours.push(s.r,s.g,s.b,s.r,s.g,s.b)}show(){this.geometry.dispose(),this.geometry.setAttribute("position",new ie(this.points,3)),this.geometry.setAttribute("color",new ie(this.colours,3))}},fT=new Xt,tu=class{constructor(t){this.app=t,this.on=Object.fromEntries(bf.map(([n,,s])=>[n,s]));let{stage:e}=t;this.frames=new kr(e.helpers),this.joints=new kr(e.helpers),this.contactLines=new kr(e.helpers),this.inertia=new kr(e.helpers),this.mass=this.instances(new hi(.018,16,12),16762173,.95),this.contactPoints=this.instances(new hi(.012,10,8),16726925,.95),this.makeGrid(),this.makeFloor(),this.labels=document.getElementById("labels"),this.paths=new Map,e.before.push(()=>this.update()),t.stage.after.push(()=>this.placeLabels()),t.on("packet:contacts",n=>{this.contacts=n,this.drawContacts(),e.invalidate()})}instances(t,e,n){let s=new Vn({color:e,transparent:!0,opacity:n,depthTest:!1,fog:!1}),r=new Os(t,s,1);return r.frustumCulled=!1,r.renderOrder=4,r.count=0,this.app.stage.helpers.add(r),{mesh:r,resize:o=>{o>r.instanceMatrix.count&&(r.instanceMatrix=new Cr(new Float32Array(32*o),16)),r.count=o}}}makeGrid(){let t=new kr(this.app.stage.helpers,!0),e=t.object,n=cT/2,s=new R,r=new R;for(let a=-n;a<=n;a++)for(let l=-n;l<n;l++)t.add(s.set(a,l,0),r.set(a,l+1,0),a?9937066:6976640),t.add(s.set(l,a,0),r.set(l+1,a,0),a?9937066:6976640);t.show(),Object.assign(e.material,{opacity:.32,depthWrite:!1,fog:!0}),e.renderOrder=0,e.position.z=y0,this.grid=e;let o=new Cn;x0.forEach((a,l)=>{let c=[0,0,.004];c[l]+=.5,o.add(new ti(new pe().setFromPoints([new R(0,0,.004),new R(...c)]),new Ai({color:a})))}),this.origin=o,this.app.stage.helpers.add(o)}makeFloor(){let t=new us({color:14015198,polygonOffset:!0,polygonOffsetFactor:2,polygonOffsetUnits:2});this.floor=new St(new qa(hT,48),t),this.floor.receiveShadow=!0,this.floor.visible=!1,this.level=null,this.app.stage.helpers.add(this.floor)}placeFloor(){let{world:t,scene:e}=this.app,n=e.bare?t.boxOf(()=>!0):null;n===null||n.isEmpty()||t.floors.length||t.terrains.length?(this.level=null,this.grid.scale.setScalar(1)):this.level===null&&(this.level=n.min.z,this.grid.scale.setScalar(10**Math.round(Math.log10(n.getSize(new R).length()/2)))),this.floor.visible=this.level!==null&&this.on.grid,t.drawnFloor=this.floor.visible?this.level:null,this.floor.position.z=this.level??0,this.grid.position.z=this.floor.position.z+y0}set(t,e){let{stage:n,world:s}=this.app;this.on[t]=e,t==="visuals"&&(s.visuals.visible=e),t==="collisions"&&(s.collisions.visible=e,s.place(!0)),t==="grid"&&(this.grid.visible=this.origin.visible=e,this.app.scene&&this.placeFloor()),t==="shadows"&&(n.shadows=e,n.makeLights()),t==="transparent"&&this.setTransparent(e),t==="contacts"&&this.app.connection.want("contacts",e?{}:null);for(let[r,o]of[["contacts",[this.contactLines.object,this.contactPoints.mesh]],["frames",[this.frames.object]],["joints",[this.joints.object]],["inertia",[this.inertia.object]],["mass",[this.mass.mesh]]])for(let a of o)a.visible=this.on[r];for(let{mesh:r}of this.paths.values())r.visible=this.on.path;this.app.emit("layers"),n.invalidate()}setTransparent(t){for(let{mesh:e,isVisual:n,isFloor:s,geoms:r}of this.app.world.shapes){if(!n||s)continue;let o=this.app.world.arrays.geom_rgba[4*r[0]+3]*(t?.4:1);for(let a of e.userData.materials)Object.assign(a,{transparent:o<.995,opacity:o,depthWrite:o>.6,needsUpdate:!0})}}load(){for(let t of Object.keys(this.on))["transparent","collisions","visuals"].includes(t)&&this.set(t,this.on[t]);this.set("contacts",this.on.contacts),this.placeFloor()}update(){let{world:t,scene:e}=this.app;if(!e)return;t.place();let n=Math.min(.25,Math.max(.06,.03*this.app.stage.extent));this.on.frames&&this.drawFrames(n),this.on.joints&&this.drawJoints(1.2*n),this.on.inertia&&this.drawInertias(),this.on.mass&&this.drawMasses()}drawFrames(t){this.frames.clear(),this.named=[];let e=new R,n=new R,s=new Wt;for(let[r,o,a]of this.app.scene.frames)!this.app.world.isMoving[o]&&this.app.models.get(r.split("::",1)[0])?.static||(mr.multiplyMatrices(this.app.world.bodies[o],on(a,0,s)),e.setFromMatrixPosition(mr),this.named.push([r,e.clone()]),x0.forEach((l,c)=>this.frames.add(e,n.setFromMatrixColumn(mr,c).normalize().multiplyScalar(t).add(e),l)));this.frames.show()}placeLabels(){let{stage:{camera:t,canvas:e}}=this.app,n=[],s=t.position,r=this.on.frames&&this.app.scene?this.named:[],o=new Map;for(let[a]of r)o.set(Qh(a),(o.get(Qh(a))??0)+1);for(let[a,l]of[...r].sort((c,d)=>c[1].distanceTo(s)-d[1].distanceTo(s))){let c=o.get(Qh(a))>1?a:Qh(a),d=l.clone().project(t);if(Math.abs(d.x)>1||Math.abs(d.y)>1||Math.abs(d.z)>1)continue;let h=(d.x+1)/2*e.clientWidth+5,u=(1-d.y)/2*e.clientHeight,f=6.2*c.length;if(!n.some(p=>Math.abs(p.y-u)<13&&h<p.x+p.width&&p.x<h+f)&&(n.push({text:c,name:a,x:h,y:u,width:f}),n.length===uT))break}for(;this.labels.childElementCount>n.length;)this.labels.lastChild.remove();for(;this.labels.childElementCount<n.length;)this.labels.append(U("span",{class:"frame"}));n.forEach(({text:a,name:l,x:c,y:d},h)=>{let u=this.labels.children[h];u.textContent!==a&&(u.textContent=a),u.dataset.frame=l,u.style.transform=`translate(${c.toFixed(1)}px, ${d.toFixed(1)}px) translateY(-50%)`})}drawJoints(t){this.joints.clear();for(let e of this.app.scene.joints)for(let[n,s,r]of e.axes){let o=new R(...s).applyMatrix4(this.app.world.bodies[n]),a=new R(...r).transformDirection(this.app.world.bodies[n]);this.joints.add(o.clone().addScaledVector(a,-t),o.clone().addScaledVector(a,t),e.type==="prismatic"?1222036:16098596)}this.joints.show()}massiveBodies(){let{arrays:t}=this.app.scene;return[...this.app.scene.arrays.moving].filter(e=>t.body_mass[e]>1e-6)}drawInertias(){let{arrays:t}=this.app.scene,e=new Wt,n=new R,s=new R,r=new R;this.inertia.clear();for(let o of this.massiveBodies()){let a=t.body_mass[o],[l,c,d]=t.body_inertia.subarray(3*o,3*o+3),h=u=>Math.sqrt(Math.max(6*u/a,1e-8));on([...t.body_ipos.subarray(3*o,3*o+3),...t.body_iquat.subarray(4*o,4*o+4)],0,e),e.scale(n.set(h(c+d-l),h(l+d-c),h(l+c-d))),mr.multiplyMatrices(this.app.world.bodies[o],e);for(let[u,f]of dT)this.inertia.add(s.fromArray(u).applyMatrix4(mr),r.fromArray(f).applyMatrix4(mr),11819990)}this.inertia.show()}drawMasses(){let{arrays:t}=this.app.scene,e=this.massiveBodies(),{mesh:n,resize:s}=this.mass;s(e.length);let r=new R,o=Math.max(...e.map(a=>t.body_mass[a]),1e-6);e.forEach((a,l)=>{r.fromArray(t.body_ipos,3*a).applyMatrix4(this.app.world.bodies[a]);let c=.5+1.5*Math.cbrt(t.body_mass[a]/o);n.setMatrixAt(l,mr.makeScale(c,c,c).setPosition(r))}),n.instanceMatrix.needsUpdate=!0}drawContacts(){let{position:t,force:e}=this.contacts.arrays,n=t.length/3,{mesh:s,resize:r}=this.contactPoints;r(n),this.contactLines.clear();let o=new R,a=new R,l=new R;for(let c=0;c<n;c++){o.fromArray(t,3*c),s.setMatrixAt(c,mr.makeTranslation(o)),l.fromArray(e,3*c);let d=l.length();d>1e-4&&(a.copy(o).addScaledVector(l,.1*Math.log10(10*(1+d))/d),this.contactLines.add(o,a,16726925))}s.instanceMatrix.needsUpdate=!0,this.contactLines.show()}setPaths(t){for(let{mesh:e}of this.paths.values())this.app.stage.helpers.remove(e),e.geometry.dispose();this.paths.clear();for(let[e,n]of Object.entries(t))this.pathOf(e).points=n;for(let e of this.paths.keys())this.drawPath(e)}pathOf(t){if(!this.paths.has(t)){let e=new St(new pe,new Vn({color:this.app.isRobot(t)?aT:lT,side:Mn,polygonOffset:!0,polygonOffsetFactor:-2,polygonOffsetUnits:-2}));e.frustumCulled=!1,e.visible=this.on.path,this.app.stage.helpers.add(e),this.paths.set(t,{points:[],mesh:e})}return this.paths.get(t)}extendPaths(t){for(let[e,n]of t){let s=this.pathOf(e),{points:r}=s,o=r.at(-1),[a,l,c]=this.app.world.bodies[n].elements.slice(12,15);o&&Math.hypot(a-o[0],l-o[1],c-o[2])<.015||(r.push([a,l,c]),r.length>8e3&&(s.points=r.filter((d,h)=>h%2===0)),this.on.path&&r.length>1&&this.drawPath(e))}}drawPath(t){let{points:e,mesh:n}=this.paths.get(t),s=e.length;if(s<2)return;let r=Math.min(.03,Math.max(.008,.0022*this.app.stage.extent)),o=e[0][2]<.6?.012-e[0][2]:0,a=new Float32Array(6*s),l=new Uint32Array(6*(s-1));for(let c=0;c<s;c++){let d=e[Math.max(0,c-1)],h=e[Math.min(s-1,c+1)],u=h[0]-d[0],f=h[1]-d[1],p=Math.hypot(u,f)||1,[_,m,g]=e[c],y=-f/p*r,T=u/p*r;a.set([_+y,m+T,g+o,_-y,m-T,g+o],6*c),c<s-1&&l.set([2*c,2*c+1,2*c+2,2*c+1,2*c+3,2*c+2],6*c)}n.geometry.dispose(),n.geometry=new pe,n.geometry.setAttribute("position",new Le(a,3)),n.geometry.setIndex(new Le(l,1))}};var pT=4,v0=8,mT=/camera|depth|rgbd/,jo=new Wt,gT=new Wt;function Sl(i,t=St){let e=new t(new pe,i);return e.frustumCulled=!1,e}var Ml=i=>mT.test(i.kind)&&!!i.camera,eu=class{constructor(t){this.app=t;let{helpers:e}=t.stage;this.points=Sl(new Us({color:16723231,size:3,sizeAttenuation:!1,fog:!1}),sr),this.fan=Sl(new Vn({color:3832831,transparent:!0,opacity:.16,side:Mn,depthWrite:!1,fog:!1})),this.frusta=Sl(new Ai({color:16098596,transparent:!0,opacity:.9,fog:!1}),ir),this.cones=Sl(new Vn({color:1222036,transparent:!0,opacity:.3,side:Mn,depthWrite:!1,fog:!1})),this.fan.renderOrder=this.cones.renderOrder=2,this.points.renderOrder=3,e.add(this.points,this.fan,this.frusta,this.cones),this.clouds=new Map,this.ranges={},t.on("packet:lidar",n=>this.drawLidars(n)),t.on("packet:ranges",n=>{this.ranges=n.ranges,t.stage.invalidate()}),t.on("packet:cloud",n=>this.drawCloud(n)),t.on("layers",()=>this.want()),t.on("select",()=>this.want()),t.on("scene",()=>this.load()),t.stage.before.push(()=>this.update())}load(){let{sensors:t}=this.app.scene;this.lidars=t.filter(e=>e.lidar),this.sonars=t.filter(e=>e.sonar),this.cameras=t.filter(Ml),this.want()}want(){if(!this.lidars)return;let{layers:t,connection:e,selected:n,robots:s}=this.app,r=this.lidars;if(r.length>v0){let a=(n??s[0]?.name??"").split("::",1)[0];r=r.filter(l=>l.name.startsWith(`${a}::`)).slice(0,v0)}this.fan.visible=this.points.visible=t.on.lidar,this.cones.visible=t.on.frusta||t.on.lidar,this.frusta.visible=t.on.frusta,e.want("lidar",t.on.lidar&&r.length?r.map(a=>a.name):null),e.want("ranges",this.cones.visible&&this.sonars.length?this.sonars.map(a=>a.name):null);let o=t.on.clouds?this.app.scene.clouds.slice(0,pT):[];for(let a of o)e.want(`cloud:${a}`,{});for(let[a,l]of this.clouds)o.includes(a)||(this.app.stage.helpers.remove(l),this.clouds.delete(a));for(let a of Object.keys(e.wants))a.startsWith("cloud:")&&!o.includes(a.slice(6))&&e.want(a,null)}drawLidars({lidars:t,arrays:{points:e,origins:n}}){let s=[],r=[],o=[],a=0;t.forEach(([l,c],d)=>{let h=this.lidars?.find(_=>_.name===l)?.lidar,u=!h||h.v_samples===1,f=r.length/3;u&&r.push(...n.slice(3*d,3*d+3));let p=-2;for(let _=a;_<a+c;_++){let m=e[3*_],g=e[3*_+1],y=e[3*_+2];Number.isNaN(m)||(s.push(m,g,y),u&&(r.push(m,g,y),p===_-1&&o.push(f,r.length/3-2,r.length/3-1),p=_))}a+=c});for(let[l,c]of[[this.points,s],[this.fan,r]])l.geometry.dispose(),l.geometry=new pe,l.geometry.setAttribute("position",new ie(c,3));this.fan.geometry.setIndex(o),this.app.stage.invalidate()}drawCloud({kind:t,error:e,arrays:{points:n,colours:s}}){if(e){this.app.report(`${t.slice(6)}: ${e}`);return}let r=t.slice(6);if(!this.clouds.has(r)){let c=Sl(new Us({size:2.5,sizeAttenuation:!1,vertexColors:!0,fog:!1}),sr);this.app.stage.helpers.add(c),this.clouds.set(r,c)}let o=this.clouds.get(r),a=new Float32Array(n.length),l=new Xt;for(let c=0;c<n.length;c+=3)s?l.setRGB(s[c]/255,s[c+1]/255,s[c+2]/255,Te):l.setHSL(.66-.66*Math.min(Math.max(n[c+2]/2,0),1),.9,.5),a.set([l.r,l.g,l.b],c);o.geometry.dispose(),o.geometry=new pe,o.geometry.setAttribute("position",new Le(n.slice(),3)),o.geometry.setAttribute("color",new Le(a,3)),this.app.stage.invalidate()}poseOf(t,e=new Wt){return e.multiplyMatrices(this.app.world.bodies[t.body],on(t.pose,0,gT))}update(){!this.app.scene||!this.lidars||(this.frusta.visible&&this.drawFrusta(),this.cones.visible&&this.sonars.length&&this.drawCones())}drawFrusta(){let t=[],e=new R,n=new R;for(let s of this.cameras){let{width:r,height:o,hfov:a,far:l}=s.camera,c=Math.min(l||1,.6),d=Math.tan(Math.min(a,2.6)/2)*c,h=d*o/r;this.poseOf(s,jo),n.setFromMatrixPosition(jo);let u=[[-1,-1],[1,-1],[1,1],[-1,1]].map(([f,p])=>e.set(c,f*d,p*h).applyMatrix4(jo).toArray());u.forEach((f,p)=>t.push(...n,...f,...f,...u[(p+1)%4]))}this.frusta.geometry.dispose(),this.frusta.geometry=new pe,this.frusta.geometry.setAttribute("position",new ie(t,3))}drawCones(){let t=[],e=new R,n=new R,s=24;for(let r of this.sonars){let{field_of_view:o,axis:a,range_max:l}=r.sonar,c=this.ranges[r.name]>0?this.ranges[r.name]:l,d=new R(...a),h=new R(0,1,0).cross(d);h.lengthSq()<1e-6&&h.set(1,0,0),h.normalize();let u=d.clone().cross(h),f=Math.tan(Math.min(o/2,1.4))*c;this.poseOf(r,jo),n.setFromMatrixPosition(jo);let p=_=>{let m=2*Math.PI*_/s;return e.copy(d).multiplyScalar(c).addScaledVector(h,f*Math.cos(m)).addScaledVector(u,f*Math.sin(m)).applyMatrix4(jo).toArray()};for(let _=0;_<s;_++)t.push(...n,...p(_),...p(_+1))}this.cones.geometry.dispose(),this.cones.geometry=new pe,this.cones.geometry.setAttribute("position",new ie(t,3))}};var S0=290,_T="control_msgs/action/PointHead";function M0(i){let t=U("select",{id:"camera",title:"Camera",onchange:()=>T()}),e=U("canvas",{id:"picture",width:S0,height:180,onclick:M=>m(M)}),n=e.getContext("2d"),s=U("div",{class:"dim"}),r=Jo("own-picture","as the sensor sees it",!1,()=>T()),o=ni("camera-panel","Camera",t,e,s,r),a=new An(60,1.6,.02,300),l=null,c=null,d=[],h=-1e4,u=null,f=null,p=!1,_=()=>i.ask("interfaces").then(({actions:M})=>{p=Object.values(M).includes(_T),e.style.cursor=p?"crosshair":"",e.title=p?"Click: the head looks there":""}).catch(()=>{}),m=M=>{if(!p||!g())return;let b=e.getBoundingClientRect();i.ask("look",{camera:g().name,x:(M.clientX-b.left)/b.width,y:(M.clientY-b.top)/b.height}).then(({action:x})=>{s.textContent=x}).catch(x=>i.report(x.message))},g=()=>d[t.selectedIndex],y=()=>!r.hidden&&r.querySelector("input").checked,T=()=>{u&&i.connection.want(u,null),u=null,g()&&(e.height=Math.round(S0*Math.min(1.2,g().camera.height/g().camera.width)),l?.dispose(),l=new Xn(e.width,e.height,{colorSpace:Te,samples:i.stage.isSoftware?0:4}),c=new Uint8Array(4*e.width*e.height),s.textContent=y()?g().topic:"drawn by the browser",y()&&o.open&&i.connection.want(u=`image:${g().name}`,{}),h=-1e4,i.stage.invalidate())},v=()=>{let M=performance.now();if(!g()||y()||!o.open||o.hidden)return;let b=h+(i.stage.isSoftware?700:80)-M;if(b>0){f??=setTimeout(()=>{f=null,v()},b);return}h=M;let{stage:x}=i,{gl:w,scene:O,helpers:P,sky:L}=x;i.views.aim(a,g(),e.width/e.height),a.near=Math.max(.01,g().camera.near||.02),a.updateProjectionMatrix(),P.visible=!1,L.position.copy(a.position),w.setRenderTarget(l),w.render(O,a),w.readRenderTargetPixels(l,0,0,e.width,e.height,c),w.setRenderTarget(null),P.visible=!0;let B=n.createImageData(e.width,e.height),G=4*e.width;for(let D=0;D<e.height;D++)B.data.set(c.subarray((e.height-1-D)*G,(e.height-D)*G),D*G);for(let D=3;D<B.data.length;D+=4)B.data[D]=255;n.putImageData(B,0,0)};return i.on("packet:image",async M=>{if(M.kind!==u)return;if(s.textContent=M.error??g().topic,M.error){n.clearRect(0,0,e.width,e.height);return}let b=await createImageBitmap(new Blob([M.arrays.jpeg],{type:"image/jpeg"}));n.drawImage(b,0,0,e.width,e.height)}),i.on("scene",M=>{let b=g()?.name;d=M.sensors.filter(Ml),o.hidden=d.length===0,t.hidden=d.length<2,r.hidden=!!M.recording,t.replaceChildren(...d.map(x=>U("option",{},x.name))),t.selectedIndex=Math.max(0,d.findIndex(x=>x.name===b)),M.recording||_(),T()}),i.on("link",M=>{M&&!i.player&&_()}),o.addEventListener("toggle",T),i.stage.after.push(v),o.hidden=!0,o}function nu(i){let t=U("div",{class:"calls"}),e=new Map,n=s=>{let r=U("span",{class:"status"}),o=U("pre",{}),a=U("button",{onclick:()=>i.send("cancel",{goal:s.id})},"Cancel"),l=U("div",{class:"call","data-call":s.id},U("div",{class:"call-head"},U("span",{class:"name",title:s.name},U("bdi",{},s.name)),r,a),o);return t.prepend(l),{box:l,status:r,text:o,cancel:a}};return i.on("packet:calls",({calls:s})=>{for(let r of s){e.has(r.id)||e.set(r.id,n(r));let{box:o,status:a,text:l,cancel:c}=e.get(r.id);a.textContent=r.status.toLowerCase(),o.className=`call ${r.status.toLowerCase()}`,c.hidden=r.done||r.kind!=="goal";let d=[r.reason,r.text&&`${r.kind==="goal"?r.is_result?"result":"feedback":"response"}:
${r.text}`].filter(Boolean).join(`
`);l.textContent!==d&&(l.textContent=d),l.hidden=!d}for(let[r,{box:o}]of e)s.some(a=>a.id===r)||(o.remove(),e.delete(r))}),t}var w0=2,iu=class{constructor({type:t,types:e}){this.types=e,this.root=this.message(t,e[t].default,0),this.element=U("div",{class:"form"},this.root.element),e[t].fields.length||this.element.append(U("p",{class:"dim"},"no fields"))}read(){let t=[],e=this.root.read(t,"");if(t.length)throw new Error(t.join("; "));return e}message(t,e,n){let s=this.types[t],r=s.fields.map(o=>[o,this.field(o,e?.[o.name]??s.default[o.name],n)]);return{element:U("div",{class:"fields"},...r.map(([,o])=>o.element)),read:(o,a)=>Object.fromEntries(r.map(([l,c])=>[l.name,c.read(o,a?`${a}.${l.name}`:l.name)]))}}field(t,e,n){let s=`${t.name}: ${t.type}${t.array?`[${t.array.length||""}]`:""}${xT(t)}`;if(t.array)return this.array(t,e??[],n,s);if(t.kind==="message"){let o=this.message(t.type,e,n+1);return{element:U("details",{class:"nested",open:n<w0},U("summary",{title:s},t.name,U("span",{class:"type"},t.type.replace("/msg/","/"))),o.element),read:o.read}}let r=b0(t,e);return{element:U("label",{class:"field-row",title:s},U("span",{},t.name),r.element),read:r.read}}array(t,e,n,s){if(t.kind==="number"||t.kind==="integer")return this.numbers(t,e,s);let r=U("div",{class:"items"}),o=[],a=t.array.length||t.array.most||1e3,l=f=>{if(o.length>=a)return;let p=t.kind==="message"?this.message(t.type,f,n+1):b0(t,f??(t.kind==="bool"?!1:"")),_=U("button",{class:"drop",title:"Remove",hidden:t.array.length>0,onclick:()=>{o.splice(o.indexOf(p),1),m.remove(),h()}},"\u2715"),m=U("div",{class:"item"},p.element,_);o.push(p),r.append(m),h()},c=U("span",{class:"dim"}),d=U("button",{class:"more",hidden:t.array.length>0,onclick:()=>l(null)},"+"),h=()=>{c.textContent=`${o.length} item${o.length===1?"":"s"}`},u=U("details",{class:"nested",open:n<w0},U("summary",{title:s},t.name,U("span",{class:"type"},`${t.type.replace("/msg/","/")}[]`),c),r,d);h();for(let f of e)l(f);return{element:u,read:(f,p)=>o.map((_,m)=>_.read(f,`${p}[${m}]`))}}numbers(t,e,n){let s=U("input",{value:e.join(", "),placeholder:"numbers, with commas between them",spellcheck:!1}),r=(o,a)=>{let l=s.value.split(/[\s,;]+/).filter(Boolean),{length:c,most:d}=t.array,h=l.map((u,f)=>T0(t,u,o,`${a}[${f}]`));return c&&h.length!==c&&o.push(`${a}: ${c} numbers are needed, found ${h.length}`),d&&h.length>d&&o.push(`${a}: at most ${d} numbers, found ${h.length}`),s.classList.toggle("wrong",o.some(u=>u.startsWith(a))),h};return{element:U("label",{class:"field-row",title:n},U("span",{},t.name),s),read:r}}};function xT(i){return i.kind==="integer"?`, ${i.low} to ${i.high}`:i.kind==="text"&&i.most?`, at most ${i.most} characters`:""}function T0(i,t,e,n){if(i.kind==="number"&&/^[+-]?nan$/i.test(t))return null;let s=t.trim()===""?NaN:Number(t);return!Number.isFinite(s)||i.kind==="integer"&&!Number.isInteger(s)?e.push(`${n}: found ${JSON.stringify(t)}, expected a ${i.kind==="integer"?"whole ":""}number`):(s<i.low||s>i.high)&&e.push(`${n}: ${s} is outside ${i.low} to ${i.high}`),s}function b0(i,t){if(i.kind==="bool"){let a=U("input",{type:"checkbox",checked:!!t,name:i.name});return{element:a,read:()=>a.checked}}let e=U("input",{value:t??(i.kind==="number"?"nan":""),name:i.name,spellcheck:!1});i.kind==="text"?i.most&&(e.maxLength=i.most):e.inputMode="decimal";let n=(a,l)=>{let c=a.length,d=i.kind==="text"?e.value:T0(i,e.value,a,l);return e.classList.toggle("wrong",a.length>c),d};if(!i.constants?.length)return{element:e,read:n};let s=U("select",{name:i.name,onchange:()=>r()},...i.constants.map(([a,l])=>U("option",{value:l},`${a} = ${l}`)),U("option",{value:""},"other \u2026")),r=()=>{let a=i.constants[s.selectedIndex];e.hidden=!!a,a&&(e.value=a[1])},o=i.constants.findIndex(([,a])=>a===t);return s.selectedIndex=o<0?i.constants.length:o,e.hidden=o>=0,{element:U("span",{class:"choice"},s,e),read:n}}function E0(i){let t={},e={},n=null,s=null,r=U("input",{id:"call-search",type:"search",placeholder:"Find a service or action",oninput:()=>m()}),o=U("div",{class:"call-names"}),a=U("div",{class:"call-title"}),l=U("div",{class:"call-form"}),c=U("button",{id:"call-send",onclick:()=>y()},"Call"),d=U("p",{id:"call-problem",class:"wrong",hidden:!0}),h=U("pre",{id:"call-response",hidden:!0}),u=nu(i),f=U("p",{class:"dim hint"},"Choose a service or an action"),p=U("div",{class:"call-middle"},f,a,d,h,l),_=M=>{d.textContent=M,d.hidden=!M},m=()=>{let M=r.value.trim().toLowerCase(),b=(w,O,P)=>{let L=Object.keys(O).filter(B=>!M||B.toLowerCase().includes(M)||O[B].toLowerCase().includes(M)).sort();return L.length?[U("h4",{},w),...L.map(B=>U("button",{class:`leaf ${n?.name===B?"selected":""}`,title:`${B}
${O[B]}`,"data-call-name":B,onclick:()=>g(P,B,O[B])},B))]:[]},x=[...b("Actions",e,"action"),...b("Services",t,"service")];o.replaceChildren(...x.length?x:[U("p",{class:"dim"},"nothing found")])},g=async(M,b,x)=>{n={kind:M,name:b,type:x},s=null,c.disabled=!0,m(),_(""),h.hidden=!0;try{let w=new iu(await i.ask("describe",{kind:M,name:b}));if(n?.name!==b)return;s=w,c.disabled=!1,f.hidden=!0,a.replaceChildren(U("strong",{},b),U("span",{class:"type"},x),c),l.replaceChildren(s.element),c.textContent=M==="action"?"Send goal":"Call"}catch(w){n?.name===b&&_(w.message)}},y=async()=>{if(s){_(""),h.hidden=!0,c.disabled=!0;try{let M=s.read(),b=await i.ask(n.kind==="action"?"goal":"call",{name:n.name,values:M});b.text!==void 0&&(h.textContent=b.text||"done",h.hidden=!1)}catch(M){_(M.message)}c.disabled=!s}},T=()=>i.ask("interfaces").then(M=>{({services:t,actions:e}=M),m()}).catch(()=>{}),v=!1;for(let M of["scene","link"])i.on(M,()=>{v&&T()});return{element:U("div",{class:"call-tab"},U("div",{class:"side"},r,o),p,U("div",{class:"call-side"},U("h4",{},"Goals"),u)),show(M){v=M,i.connection.want("calls",M?{}:null),M&&T()}}}var xs="truth",A0=2e4,su=(i,t)=>`${i} ${t}`,ru=(i,t)=>i===t||i.startsWith(`${t}.`)||i.startsWith(`${t}[`);function Ef(){if(!window.simkitFile)return null;let{series:i}=window.simkitFile;return new Map(Object.entries(i?.byteLength?Ki(i).arrays:{}).map(([t,e])=>[t,Ki(e.slice().buffer)]))}var au=class{constructor(t){this.app=t,this.curves=new Map,this.fields=new Map,this.places=new Map,this.errors=new Map,this.listeners=[],this.isShown=!1,t.on("packet:series",e=>this.take(e,e.kind.slice(7))),t.on("packet:truth",e=>this.take(e,xs)),t.on("recording",()=>this.want()),this.file=Ef()}use(t,e,n){let s=this.fields.get(t)??new Map;this.fields.set(t,s);let r=(s.get(e)??0)+(n?1:-1);if(r>0?s.set(e,r):s.delete(e),!n)for(let[o,a]of this.curves)a.topic===t&&![...s.keys()].some(l=>ru(a.path,l))&&this.curves.delete(o);this.want(t)}show(t){this.isShown=t,this.want()}want(t=null){for(let[e,n]of this.fields){if(t!==null&&e!==t)continue;let s=[...n.keys()];if(e===xs&&this.app.player){this.takeTruth(s);continue}if(this.file){this.takeFile(e,s);continue}this.app.connection.want(e===xs?xs:`series:${e}`,this.isShown&&s.length?{fields:s}:null)}}of(t,e){return[...this.curves.values()].filter(n=>n.topic===t&&ru(n.path,e))}clear(t,e){for(let n of this.of(t,e))n.t=[],n.s=[],n.v=[]}announce(){for(let t of this.listeners)t()}take(t,e){let n=t.error?Object.fromEntries([...this.fields.get(e)?.keys()??[]].map(h=>[h,t.error])):t.errors??{};for(let[h,u]of Object.entries(n))this.errors.set(su(e,h),u);let{times:s,stamps:r,values:o}=t.arrays,a=t.curves?.length??0,l=this.places.get(e),c=t.first??0,d=!t.recorded&&l?.source===t.source?Math.max(0,l.next-c):0;t.recorded||this.places.set(e,{source:t.source,next:c+(s?.length??0)});for(let h=0;h<a;h++){let u=this.curve(e,t.curves[h]);if(u){t.recorded&&(u.t=[],u.s=[],u.v=[]);for(let f=d;f<s.length;f++)this.push(u,t.begin+s[f],t.begin+r[f],t.curves[h].base+o[f*a+h])}}this.announce()}curve(t,{path:e,unit:n,is_angle:s}){if(![...this.fields.get(t)?.keys()??[]].some(l=>ru(e,l)))return null;let o=su(t,e),a=t===xs?`${e} (truth)`:`${t}${e.startsWith("[")?"":"."}${e}`;return this.curves.has(o)||this.curves.set(o,{key:o,topic:t,path:e,label:a,unit:n,isAngle:s,t:[],s:[],v:[]}),this.curves.get(o)}push(t,e,n,s){let{t:r,s:o,v:a}=t;if(r.length&&e<r[r.length-1]-1e-9&&(r.length=o.length=a.length=0),r.push(e),o.push(n),a.push(s),r.length>A0)for(let l of[r,o,a])l.splice(0,A0/10)}takeFile(t,e){let n=this.file.get(t)??{curves:[],arrays:{}};this.take(n,t);for(let s of e)n.curves.some(r=>ru(r.path,s))||this.errors.set(su(t,s),"this file does not contain the field")}takeTruth(t){let{recording:e,times:n,size:s}=this.app.player,r=[...this.app.scene.arrays.moving];for(let o of t){let a=o.lastIndexOf("."),l=o.slice(0,a),c=o.slice(a+1),d=this.app.bodyOf.get(l),h=Af[c];if(d===void 0||!h){this.errors.set(su(xs,o),`there is no ${o}`);continue}let u=this.curve(xs,{path:o,unit:h.unit,is_angle:h.isAngle});if(!u||u.t.length)continue;let f=7*r.indexOf(d),p=_=>yT(e.arrays.poses,_*s+f);for(let _=0;_<n.length;_++){let m=Math.max(_-1,0),g=Math.min(_+1,n.length-1);this.push(u,e.begin+n[_],NaN,h(p(_),p(m),p(g),n[g]-n[m]||1))}}this.announce()}},C0=new Wt,ou=new Qn;function yT(i,t){return on(i,t,C0),ou.setFromRotationMatrix(C0,"ZYX"),{x:i[t],y:i[t+1],z:i[t+2],roll:ou.x,pitch:ou.y,yaw:ou.z}}var ki=(i,t,e=!1)=>Object.assign(t,{unit:i,isAngle:e}),Tf=i=>(t,e,n,s)=>(n[i]-e[i])/s,R0=(i,t,e,n,s)=>(Math.cos(s)*(e.x-t.x)+Math.sin(s)*(e.y-t.y))/n,Af={x:ki("m",i=>i.x),y:ki("m",i=>i.y),z:ki("m",i=>i.z),roll:ki("rad",i=>i.roll,!0),pitch:ki("rad",i=>i.pitch),yaw:ki("rad",i=>i.yaw,!0),vx:ki("m/s",Tf("x")),vy:ki("m/s",Tf("y")),vz:ki("m/s",Tf("z")),forward:ki("m/s",(i,t,e,n)=>R0(i,t,e,n,i.yaw)),left:ki("m/s",(i,t,e,n)=>R0(i,t,e,n,i.yaw+Math.PI/2)),yaw_rate:ki("rad/s",(i,t,e,n)=>Math.atan2(Math.sin(e.yaw-t.yaw),Math.cos(e.yaw-t.yaw))/n)};var Cf=[["debug",10],["info",20],["warn",30],["error",40],["fatal",50]],P0=2e3,I0=500;function L0(i){let t=[],e=null,n=0,s=!1,r=!1,o=0,a=U("select",{id:"log-level",title:"Lowest level",onchange:()=>g()},...Cf.map(([M])=>U("option",{value:M},M)));a.selectedIndex=1;let l=U("input",{id:"log-node",type:"search",placeholder:"Node",oninput:()=>g()}),c=U("input",{id:"log-text",type:"search",placeholder:"Text",oninput:()=>g()}),d=U("span",{id:"log-count",class:"dim"}),h=U("input",{type:"checkbox",id:"log-follow",checked:!0,onchange:()=>g()}),u=U("div",{id:"log-rows",role:"log"}),f=U("div",{class:"tab-tools"},a,l,c,U("label",{class:"check"},h,"Follow"),U("button",{id:"log-clear",onclick:()=>{t=[],g()}},"Clear"),d),p=M=>M.level>=Cf[a.selectedIndex][1]&&M.node.toLowerCase().includes(l.value.trim().toLowerCase())&&M.text.toLowerCase().includes(c.value.trim().toLowerCase()),_=M=>{let b=Cf.findLast(([,x])=>M.level>=x)?.[0]??"debug";return U("div",{class:`log ${b}`,title:M.place},U("span",{class:"time"},M.time.toFixed(3)),U("span",{class:"level"},b),U("span",{class:"node"},M.node),U("span",{class:"text"},M.text))},m=M=>{d.textContent=`${M.length} of ${t.length} messages`},g=()=>{let M=t.filter(p);u.replaceChildren(...M.slice(-I0).map(_)),m(M),h.checked&&(u.scrollTop=u.scrollHeight)},y=M=>{for(t.push(...M),t.length>P0&&t.splice(0,t.length-P0),u.append(...M.filter(p).map(_));u.childElementCount>I0;)u.firstChild.remove();m(t.filter(p)),h.checked&&(u.scrollTop=u.scrollHeight)},T=async()=>{if(!s){s=!0;try{for(;r&&n<o;){let M=await i.ask("log",{after:n});if(!M.length)break;n=M.at(-1).number,y(M)}}catch{}s=!1}};i.on("packet:log",M=>{M.source!==e&&(t=[],n=0,e=M.source,g()),o=M.last,T()}),i.console={get entries(){return t}};let v=Ef();return v&&y(v.get("log")?.entries??[]),{element:U("div",{class:"console-tab"},f,u),show(M){r=M,i.connection.want("log",M?{}:null)}}}var vT="http://www.w3.org/2000/svg",ST=16,D0=1.35,Rf=44;function Gs(i,t,...e){let n=document.createElementNS(vT,i);for(let[s,r]of Object.entries(t))n.setAttribute(s,r);return n.append(...e),n}var MT=i=>i.length<=Rf?i:`${i.slice(0,Rf-1>>1)}\u2026${i.slice(-(Rf-1>>1))}`;function wT(i){let t=`M${i[0][0]} ${i[0][1]}`;for(let e=1;e<i.length;e++){let[n,s]=i[e-1],[r,o]=i[e],a=(r-n)/2;t+=e%2?`C${n+a} ${s} ${r-a} ${o} ${r} ${o}`:`L${r} ${o}`}return t}var Pf=class{constructor(t){this.svg=Gs("svg",{class:"graph",id:t,tabindex:0}),this.shown="",this.view=null,this.svg.addEventListener("wheel",e=>{e.preventDefault(),this.zoom(Math.exp(e.deltaY*.0015),e.offsetX,e.offsetY)},{passive:!1}),this.svg.addEventListener("dblclick",()=>this.fit()),this.svg.addEventListener("pointerdown",e=>{this.svg.setPointerCapture(e.pointerId);let[n,s]=[e.clientX,e.clientY],r=o=>{let a=this.view[2]/this.svg.clientWidth;this.view[0]-=(o.clientX-n)*a,this.view[1]-=(o.clientY-s)*a,[n,s]=[o.clientX,o.clientY],this.apply()};this.svg.addEventListener("pointermove",r),this.svg.addEventListener("lostpointercapture",()=>this.svg.removeEventListener("pointermove",r),{once:!0})}),new ResizeObserver(()=>{!this.view||this.isFitted?this.begin():this.keepShape()}).observe(this.svg)}zoom(t,e,n){if(!this.view)return;let[s,r,o,a]=this.view,l=Math.min(Math.max(o*t,80),4e4)/o,c=s+o*e/this.svg.clientWidth,d=r+a*n/this.svg.clientHeight;this.view=[c-(c-s)*l,d-(d-r)*l,o*l,a*l],this.isFitted=!1,this.apply()}keepShape(){this.view[3]=this.view[2]*this.svg.clientHeight/Math.max(this.svg.clientWidth,1),this.apply()}fit(){let{clientWidth:t,clientHeight:e}=this.svg;if(!this.size||!t||!e)return;let n=Math.max((this.size[0]+32)/t,(this.size[1]+32)/e,1);this.view=[this.size[0]/2-t*n/2,this.size[1]/2-e*n/2,t*n,e*n],this.isFitted=!0,this.apply()}begin(){if(this.fit(),!this.size||!this.view||this.view[2]/this.svg.clientWidth<D0)return;let{clientWidth:t,clientHeight:e}=this.svg,n=Math.min(Math.max((this.size[0]+32)/t,1),D0),s=this.size[0]>t*n?-16:(this.size[0]-t*n)/2;this.view=[s,this.root===null?-12:this.root-e*n/2,t*n,e*n],this.isFitted=!1,this.apply()}apply(){this.svg.setAttribute("viewBox",this.view.join(" "))}draw({boxes:t,edges:e,size:n}){let s=JSON.stringify([t,e]);if(s===this.shown)return;this.shown=s;let r=!this.size||this.isFitted||String(n)!==String(this.size);this.size=n,this.rates=new Map;let o=Gs("marker",{id:`${this.svg.id}-tip`,viewBox:"0 0 8 8",refX:7,refY:4,markerWidth:7,markerHeight:7,orient:"auto"},Gs("path",{class:"tip",d:"M0 0L8 4L0 8z"})),a=e.map(c=>{let d=Gs("path",{class:`edge${c.dashed?" dashed":""}`,d:wT(c.points),"marker-end":`url(#${this.svg.id}-tip)`});return d.ends=c.ends,d});this.svg.replaceChildren(Gs("defs",{},o),...a,...t.map(c=>this.box(c,a)));let l=t.filter(c=>c.place[0]<100&&t.every(d=>d.place[0]>=c.place[0]));this.root=l.length===1?l[0].place[1]+l[0].place[3]/2:null,r&&this.begin()}box({name:t,kind:e,head:n,above:s,lines:r,place:[o,a,l,c]},d){let u=[...s?[[s,"small"]]:[],[n,"head"],...r.map(_=>[_,"small"])].map(([_,m],g)=>Gs("text",{class:m,x:o+l/2,y:a+18+g*ST,"text-anchor":"middle"},MT(_)));r.at(-1)===""&&this.rates.set(t,u.at(-1));let f=Gs("g",{class:`box ${e}`,"data-box":t},Gs("title",{},t),Gs("rect",{x:o,y:a,width:l,height:c,rx:e==="node"?6:Math.min(c/2,16)}),...u),p=_=>{for(let m of d)m.ends.includes(t)&&m.classList.toggle("marked",_)};return f.addEventListener("pointerenter",()=>p(!0)),f.addEventListener("pointerleave",()=>p(!1)),f}showRates(t){for(let[e,n]of this.rates??[])n.textContent=t(e)}},N0=i=>i===void 0?"":`${i>=10?i.toFixed(1):i.toFixed(2)} Hz`;function O0(i,t,e,n,s){let r=new Pf(t),o=U("p",{class:"dim hint",hidden:!0}),a=U("div",{class:"tab-tools"},...n,U("button",{onclick:()=>r.zoom(1/1.3,r.svg.clientWidth/2,r.svg.clientHeight/2),title:"Zoom in"},"+"),U("button",{onclick:()=>r.zoom(1.3,r.svg.clientWidth/2,r.svg.clientHeight/2),title:"Zoom out"},"\u2212"),U("button",{id:`${t}-fit`,onclick:()=>r.fit(),title:"Show everything"},"Fit"),U("span",{class:"dim legend-text"},"drag: move, wheel: zoom"));return i.on(`packet:${e}`,l=>{r.draw(l),o.hidden=l.boxes.length>0,o.textContent=l.count>l.most?`${l.count} boxes are too many to draw; use simkit graph`:s}),{view:r,element:U("div",{class:"graph-tab"},a,U("div",{class:"graph-area"},r.svg,o))}}function U0(i){let t=!1,e={},n=U("input",{type:"checkbox",id:"graph-all",onchange:()=>o()}),{view:s,element:r}=O0(i,"node-graph","graph",[U("label",{class:"check"},n,"All names")],"There are no nodes with topics."),o=()=>i.connection.want("graph",t?{all:n.checked}:null),a=()=>s.showRates(l=>N0(e[l.slice(6)]));return i.on("packet:rates",l=>{e=l.rates,a()}),i.on("packet:graph",a),{element:r,show(l){t=l,o(),i.connection.want("rates",l?{}:null)}}}function F0(i){let{view:t,element:e}=O0(i,"frame-graph","frames",[],"No transforms have come yet.");return i.on("packet:frames",({rates:n,ages:s})=>t.showRates(r=>r in s?`silent for ${s[r]} s`:N0(n[r]))),{element:e,show(n){i.connection.want("frames",n?{}:null)}}}var bT="play_motion2_msgs/action/PlayMotion2",TT="control_msgs/action/FollowJointTrajectory";function B0(i){let t=U("div",{class:"motions"}),e=U("div",{class:"controllers"}),n=nu(i),s=U("p",{class:"dim hint",hidden:!0},"No controller of this world takes motions or trajectories."),r=!1,o=async u=>{let f=[];for(let p of Object.keys(u).filter(_=>u[_]===bT)){let _=await i.ask("call",{name:`${p}/list_motions`}).catch(()=>null);for(let m of _?.values?.motion_keys??[])f.push(U("button",{"data-motion":m,title:`${p}: ${m}`,onclick:()=>i.send("goal",{name:p,values:{motion_name:m}})},m))}t.replaceChildren(...f),t.parentElement.hidden=!f.length},a=async({actions:u,services:f})=>{let p=new Map;for(let m of Object.keys(f).filter(g=>g.endsWith("/list_controllers"))){let g=await i.ask("call",{name:m}).catch(()=>null),y=m.split("/").slice(0,-2).join("/");for(let T of g?.values?.controller??[])p.set(`${y}/${T.name}`,T)}let _=Object.keys(u).filter(m=>u[m]===TT).map((m,g)=>l(m,p.get(m.slice(0,m.lastIndexOf("/"))),g===0)).filter(Boolean);e.replaceChildren(..._),e.parentElement.hidden=!_.length},l=(u,f,p)=>{let _=[...new Set((f?.claimed_interfaces??[]).map(b=>b.slice(0,b.lastIndexOf("/"))))];if(!_.length)return null;let m=_.map(b=>{let x=i.scene.joints.findIndex(D=>D.name.split("::").at(-1)===b),w=i.scene.joints[x],O=w?.lower??-Math.PI,P=w?.upper??Math.PI,L=U("output",{class:"dim"}),B=U("input",{type:"range",min:O,max:P,step:(P-O)/500,"aria-label":b,"data-target":b,oninput:()=>{G.isMoved=!0,L.textContent=(+B.value).toFixed(3)}}),G={name:b,index:x,slider:B,value:L,isMoved:!1,element:U("label",{},U("span",{},b),L,B)};return G}),g=U("input",{type:"number",min:.1,step:.1,value:2,title:"Duration [s]"}),y=U("input",{type:"range",min:.01,max:1,step:.01,value:1,"data-scale":u,"aria-label":"speed",oninput:()=>{T.textContent=`${Math.round(100*y.value)} %`}}),T=U("output",{class:"dim"},"100 %"),v=U("button",{"data-move":u,onclick:()=>{let b=Math.max(.05,+g.value||2)/y.value,x={positions:m.map(w=>+w.slider.value),time_from_start:{sec:Math.floor(b),nanosec:Math.round(b%1*1e9)}};i.send("goal",{name:u,values:{trajectory:{joint_names:_,points:[x]}}});for(let w of m)w.isMoved=!1}},"Move"),M=U("details",{open:p},U("summary",{title:u},u.split("/").slice(1,-1).join("/")),U("div",{class:"joints"},...m.map(b=>b.element),U("label",{title:"Speed scaling: the motion takes its duration, divided by this"},U("span",{},"speed"),T,y)),U("div",{class:"row-left"},g,"s",v));return M.rows=m,M},c=()=>{for(let u of e.children)for(let f of u.rows){let p=i.jointPositions[f.index];f.isMoved||!Number.isFinite(p)||(f.slider.value=p,f.value.textContent=_s(p,3))}};i.on("packet:joints",()=>{r&&c()});let d=async()=>{let u=await i.ask("interfaces").catch(()=>null);u&&(await o(u.actions),await a(u),s.hidden=!(t.parentElement.hidden&&e.parentElement.hidden),n.parentElement.hidden=!s.hidden,c())};for(let u of["scene","link"])i.on(u,()=>{r&&d()});let h=(u,...f)=>U("div",{class:"side"},U("h4",{},u),...f);return{element:U("div",{class:"motion-tab"},s,h("Motions",t),h("Trajectories",e),h("Goals",n)),show(u){r=u,i.connection.want("calls",u?{}:null),i.wantJoints("motions",u),u&&d()}}}function k0(i){let t=U("div",{class:"parameter-nodes"}),e=U("input",{id:"parameter-search",type:"search",placeholder:"Find a node or parameter",oninput:()=>a()}),n=new Map,s="",r=async(l,c,d,h)=>{try{await i.ask("set_parameter",{node:l,name:c,value:d})}catch(u){i.report(u.message),h.show(h.value)}},o=(l,c,d)=>{let h=ET(d,f=>r(l,c,f,u)),u={value:d.value,show:h.show,isBusy:h.isBusy,element:U("div",{class:"parameter","data-parameter":`${l} ${c}`,title:`${d.description||c}
${d.allowed}`},U("span",{class:"name"},c),h.element,U("span",{class:"dim about"},d.description||d.allowed))};return u},a=()=>{let l=e.value.trim().toLowerCase();for(let c of t.querySelectorAll("details")){let d=!1;for(let h of c.querySelectorAll(".parameter"))h.hidden=!h.dataset.parameter.toLowerCase().includes(l),d||=!h.hidden;c.hidden=!d}};return i.on("packet:parameters",({nodes:l})=>{let c=JSON.stringify(Object.entries(l).map(([d,h])=>[d,Object.entries(h).map(([u,f])=>[u,f.allowed,f.type])]));if(c!==s){s=c,n.clear();let d=Object.keys(l).length<4;t.replaceChildren(...Object.entries(l).map(([h,u])=>U("details",{open:d},U("summary",{},h,U("span",{class:"dim"},` ${Object.keys(u).length}`)),...Object.entries(u).map(([f,p])=>{let _=o(h,f,p);return n.set(`${h} ${f}`,_),_.element})))),Object.keys(l).length||t.append(U("p",{class:"dim"},"no node has parameters")),a()}for(let[d,h]of Object.entries(l))for(let[u,f]of Object.entries(h)){let p=n.get(`${d} ${u}`);p.value=f.value,p.isBusy()||p.show(f.value)}}),{element:U("div",{class:"parameter-tab"},U("div",{class:"tab-tools"},e),t),show(l){i.connection.want("parameters",l?{}:null)}}}function ET(i,t){let{type:e,minimum:n,maximum:s,choices:r,value:o}=i,a=d=>()=>document.activeElement===d&&!d.matches("[type=checkbox], select");if(r.length){let d=U("select",{onchange:()=>t(r[d.selectedIndex])},...r.map(h=>U("option",{},String(h))));return{element:d,show:h=>{d.selectedIndex=r.indexOf(h)},isBusy:()=>!1}}if(e==="bool"){let d=U("input",{type:"checkbox",onchange:()=>t(d.checked)});return{element:d,show:h=>{d.checked=h},isBusy:()=>!1}}if(e==="int"||e==="float"){let h=U("input",{type:"number",step:e==="int"?1:"any",min:n??"",max:s??"",onchange:()=>{h.value!==""&&t(+h.value)}});if(n===null||s===null)return{element:U("span",{class:"number"},h),show:f=>{h.value=f},isBusy:a(h)};let u=U("input",{type:"range",min:n,max:s,step:e==="int"?1:(s-n)/1e3,"aria-label":"Value",oninput:()=>{h.value=+(+u.value).toPrecision(6),t(+h.value)}});return{element:U("span",{class:"number"},u,h),show:f=>{u.value=f,h.value=+(+f).toPrecision(8)},isBusy:()=>a(h)()||u.matches(":active")}}let l=Array.isArray(o),c=U("input",{onchange:()=>t(l?c.value.split(/[\s,;]+/).filter(Boolean).map(Number):c.value)});return{element:c,show:d=>{c.value=l?d.join(", "):d},isBusy:a(c)}}var AT="uplot",CT="u-hz",RT="u-vt",PT="u-title",IT="u-wrap",LT="u-under",DT="u-over",NT="u-axis",Gr="u-off",OT="u-select",UT="u-cursor-x",FT="u-cursor-y",BT="u-cursor-pt",kT="u-legend",zT="u-live",VT="u-inline",GT="u-series",HT="u-marker",z0="u-label",WT="u-value",bl="width",Tl="height";var V0="bottom",Ko="left",If="right",$f="#000",G0=$f+"0",Lf="mousemove",H0="mousedown",Df="mouseup",W0="mouseenter",X0="mouseleave",Y0="dblclick",XT="resize",YT="scroll",q0="change",du="dppxchange",Zf="--",ra=typeof window<"u",Bf=ra?document:null,ta=ra?window:null,qT=ra?navigator:null,Re,lu;function kf(){let i=devicePixelRatio;Re!=i&&(Re=i,lu&&Vf(q0,lu,kf),lu=matchMedia(`(min-resolution: ${Re-.001}dppx) and (max-resolution: ${Re+.001}dppx)`),Hr(q0,lu,kf),ta.dispatchEvent(new CustomEvent(du)))}function Ri(i,t){if(t!=null){let e=i.classList;!e.contains(t)&&e.add(t)}}function zf(i,t){let e=i.classList;e.contains(t)&&e.remove(t)}function Ke(i,t,e){i.style[t]=e+"px"}function Qi(i,t,e,n){let s=Bf.createElement(i);return t!=null&&Ri(s,t),e?.insertBefore(s,n),s}function zi(i,t){return Qi("div",i,t)}var $0=new WeakMap;function ys(i,t,e,n,s){let r="translate("+t+"px,"+e+"px)",o=$0.get(i);r!=o&&(i.style.transform=r,$0.set(i,r),t<0||e<0||t>n||e>s?Ri(i,Gr):zf(i,Gr))}var Z0=new WeakMap;function J0(i,t,e){let n=t+e,s=Z0.get(i);n!=s&&(Z0.set(i,n),i.style.background=t,i.style.borderColor=e)}var j0=new WeakMap;function K0(i,t,e,n){let s=t+""+e,r=j0.get(i);s!=r&&(j0.set(i,s),i.style.height=e+"px",i.style.width=t+"px",i.style.marginLeft=n?-t/2+"px":0,i.style.marginTop=n?-e/2+"px":0)}var Jf={passive:!0},$T={...Jf,capture:!0};function Hr(i,t,e,n){t.addEventListener(i,e,n?$T:Jf)}function Vf(i,t,e,n){t.removeEventListener(i,e,Jf)}ra&&kf();function ts(i,t,e,n){let s;e=e||0,n=n||t.length-1;let r=n<=2147483647;for(;n-e>1;)s=r?e+n>>1:Pi((e+n)/2),t[s]<i?e=s:n=s;return i-t[e]<=t[n]-i?e:n}function E_(i){return(e,n,s)=>{let r=-1,o=-1;for(let a=n;a<=s;a++)if(i(e[a])){r=a;break}for(let a=s;a>=n;a--)if(i(e[a])){o=a;break}return[r,o]}}var A_=i=>i!=null,C_=i=>i!=null&&i>0,mu=E_(A_),ZT=E_(C_);function JT(i,t,e,n=0,s=!1){let r=s?ZT:mu,o=s?C_:A_;[t,e]=r(i,t,e);let a=i[t],l=i[t];if(t>-1)if(n==1)a=i[t],l=i[e];else if(n==-1)a=i[e],l=i[t];else for(let c=t;c<=e;c++){let d=i[c];o(d)&&(d<a?a=d:d>l&&(l=d))}return[a??Ge,l??-Ge]}function gu(i,t,e,n){let s=e_(i),r=e_(t);i==t&&(s==-1?(i*=e,t/=e):(i/=e,t*=e));let o=e==10?Hs:R_,a=s==1?Pi:Vi,l=r==1?Vi:Pi,c=a(o(Ln(i))),d=l(o(Ln(t))),h=ea(e,c),u=ea(e,d);return e==10&&(c<0&&(h=He(h,-c)),d<0&&(u=He(u,-d))),n||e==2?(i=h*s,t=u*r):(i=D_(i,h),t=_u(t,u)),[i,t]}function jf(i,t,e,n){let s=gu(i,t,e,n);return i==0&&(s[0]=0),t==0&&(s[1]=0),s}var Kf=.1,Q0={mode:3,pad:Kf},Al={pad:0,soft:null,mode:0},jT={min:Al,max:Al};function fu(i,t,e,n){return xu(e)?t_(i,t,e):(Al.pad=e,Al.soft=n?0:null,Al.mode=n?3:0,t_(i,t,jT))}function Ae(i,t){return i??t}function KT(i,t,e){for(t=Ae(t,0),e=Ae(e,i.length-1);t<=e;){if(i[t]!=null)return!0;t++}return!1}function t_(i,t,e){let n=e.min,s=e.max,r=Ae(n.pad,0),o=Ae(s.pad,0),a=Ae(n.hard,-Ge),l=Ae(s.hard,Ge),c=Ae(n.soft,Ge),d=Ae(s.soft,-Ge),h=Ae(n.mode,0),u=Ae(s.mode,0),f=t-i,p=Hs(f),_=pi(Ln(i),Ln(t)),m=Hs(_),g=Ln(m-p);(f<1e-24||g>10)&&(f=0,(i==0||t==0)&&(f=1e-24,h==2&&c!=Ge&&(r=0),u==2&&d!=-Ge&&(o=0)));let y=f||_||1e3,T=Hs(y),v=ea(10,Pi(T)),M=y*(f==0?i==0?.1:1:r),b=He(D_(i-M,v/10),24),x=i>=c&&(h==1||h==3&&b<=c||h==2&&b>=c)?c:Ge,w=pi(a,b<x&&i>=x?x:es(x,b)),O=y*(f==0?t==0?.1:1:o),P=He(_u(t+O,v/10),24),L=t<=d&&(u==1||u==3&&P>=d||u==2&&P<=d)?d:-Ge,B=es(l,P>L&&t<=L?L:pi(L,P));return w==B&&w==0&&(B=100),[w,B]}var QT=new Intl.NumberFormat(ra?qT.language:"en-US"),Qf=i=>QT.format(i),Ii=Math,uu=Ii.PI,Ln=Ii.abs,Pi=Ii.floor,In=Ii.round,Vi=Ii.ceil,es=Ii.min,pi=Ii.max,ea=Ii.pow,e_=Ii.sign,Hs=Ii.log10,R_=Ii.log2,t1=(i,t=1)=>Ii.sinh(i)*t,Nf=(i,t=1)=>Ii.asinh(i/t),Ge=1/0;function n_(i){return(Hs((i^i>>31)-(i>>31))|0)+1}function Gf(i,t,e){return es(pi(i,t),e)}function P_(i){return typeof i=="function"}function Me(i){return P_(i)?i:()=>i}var e1=()=>{},I_=i=>i,L_=(i,t)=>t,n1=i=>null,i_=i=>!0,s_=(i,t)=>i==t,i1=/\.\d*?(?=9{6,}|0{6,})/gm,Wr=i=>{if(O_(i)||_r.has(i))return i;let t=`${i}`,e=t.match(i1);if(e==null)return i;let n=e[0].length-1;if(t.indexOf("e-")!=-1){let[s,r]=t.split("e");return+`${Wr(s)}e${r}`}return He(i,n)};function zr(i,t){return Wr(He(Wr(i/t))*t)}function _u(i,t){return Wr(Vi(Wr(i/t))*t)}function D_(i,t){return Wr(Pi(Wr(i/t))*t)}function He(i,t=0){if(O_(i))return i;let e=10**t,n=i*e*(1+Number.EPSILON);return In(n)/e}var _r=new Map;function N_(i){return((""+i).split(".")[1]||"").length}function Rl(i,t,e,n){let s=[],r=n.map(N_);for(let o=t;o<e;o++){let a=Ln(o),l=He(ea(i,o),a);for(let c=0;c<n.length;c++){let d=i==10?+`${n[c]}e${o}`:n[c]*l,h=(o>=0?0:a)+(o>=r[c]?0:r[c]),u=i==10?d:He(d,h);s.push(u),_r.set(u,h)}}return s}var Cl={},tp=[],na=[null,null],gr=Array.isArray,O_=Number.isInteger,s1=i=>i===void 0;function r_(i){return typeof i=="string"}function xu(i){let t=!1;if(i!=null){let e=i.constructor;t=e==null||e==Object}return t}function r1(i){return i!=null&&typeof i=="object"}var o1=Object.getPrototypeOf(Uint8Array),U_="__proto__";function ia(i,t=xu){let e;if(gr(i)){let n=i.find(s=>s!=null);if(gr(n)||t(n)){e=Array(i.length);for(let s=0;s<i.length;s++)e[s]=ia(i[s],t)}else e=i.slice()}else if(i instanceof o1)e=i.slice();else if(t(i)){e={};for(let n in i)n!=U_&&(e[n]=ia(i[n],t))}else e=i;return e}function wn(i){let t=arguments;for(let e=1;e<t.length;e++){let n=t[e];for(let s in n)s!=U_&&(xu(i[s])?wn(i[s],ia(n[s])):i[s]=ia(n[s]))}return i}var a1=0,l1=1,c1=2;function h1(i,t,e){for(let n=0,s,r=-1;n<t.length;n++){let o=t[n];if(o>r){for(s=o-1;s>=0&&i[s]==null;)i[s--]=null;for(s=o+1;s<e&&i[s]==null;)i[r=s++]=null}}}function u1(i,t){if(p1(i)){let o=i[0].slice();for(let a=1;a<i.length;a++)o.push(...i[a].slice(1));return m1(o[0])||(o=f1(o)),o}let e=new Set;for(let o=0;o<i.length;o++){let l=i[o][0],c=l.length;for(let d=0;d<c;d++)e.add(l[d])}let n=[Array.from(e).sort((o,a)=>o-a)],s=n[0].length,r=new Map;for(let o=0;o<s;o++)r.set(n[0][o],o);for(let o=0;o<i.length;o++){let a=i[o],l=a[0];for(let c=1;c<a.length;c++){let d=a[c],h=Array(s).fill(void 0),u=t?t[o][c]:l1,f=[];for(let p=0;p<d.length;p++){let _=d[p],m=r.get(l[p]);_===null?u!=a1&&(h[m]=_,u==c1&&f.push(m)):h[m]=_}h1(h,f,s),n.push(h)}}return n}var d1=typeof queueMicrotask>"u"?i=>Promise.resolve().then(i):queueMicrotask;function f1(i){let t=i[0],e=t.length,n=Array(e);for(let r=0;r<n.length;r++)n[r]=r;n.sort((r,o)=>t[r]-t[o]);let s=[];for(let r=0;r<i.length;r++){let o=i[r],a=Array(e);for(let l=0;l<e;l++)a[l]=o[n[l]];s.push(a)}return s}function p1(i){let t=i[0][0],e=t.length;for(let n=1;n<i.length;n++){let s=i[n][0];if(s.length!=e)return!1;if(s!=t){for(let r=0;r<e;r++)if(s[r]!=t[r])return!1}}return!0}function m1(i,t=100){let e=i.length;if(e<=1)return!0;let n=0,s=e-1;for(;n<=s&&i[n]==null;)n++;for(;s>=n&&i[s]==null;)s--;if(s<=n)return!0;let r=pi(1,Pi((s-n+1)/t));for(let o=i[n],a=n+r;a<=s;a+=r){let l=i[a];if(l!=null){if(l<=o)return!1;o=l}}return!0}var F_=["January","February","March","April","May","June","July","August","September","October","November","December"],B_=["Sunday","Monday","Tuesday","Wednesday","Thursday","Friday","Saturday"];function k_(i){return i.slice(0,3)}var g1=B_.map(k_),_1=F_.map(k_),x1={MMMM:F_,MMM:_1,WWWW:B_,WWW:g1};function wl(i){return(i<10?"0":"")+i}function y1(i){return(i<10?"00":i<100?"0":"")+i}var v1={YYYY:i=>i.getFullYear(),YY:i=>(i.getFullYear()+"").slice(2),MMMM:(i,t)=>t.MMMM[i.getMonth()],MMM:(i,t)=>t.MMM[i.getMonth()],MM:i=>wl(i.getMonth()+1),M:i=>i.getMonth()+1,DD:i=>wl(i.getDate()),D:i=>i.getDate(),WWWW:(i,t)=>t.WWWW[i.getDay()],WWW:(i,t)=>t.WWW[i.getDay()],HH:i=>wl(i.getHours()),H:i=>i.getHours(),h:i=>{let t=i.getHours();return t==0?12:t>12?t-12:t},AA:i=>i.getHours()>=12?"PM":"AM",aa:i=>i.getHours()>=12?"pm":"am",a:i=>i.getHours()>=12?"p":"a",mm:i=>wl(i.getMinutes()),m:i=>i.getMinutes(),ss:i=>wl(i.getSeconds()),s:i=>i.getSeconds(),fff:i=>y1(i.getMilliseconds())};function ep(i,t){t=t||x1;let e=[],n=/\{([a-z]+)\}|[^{]+/gi,s;for(;s=n.exec(i);)e.push(s[0][0]=="{"?v1[s[1]]:s[0]);return r=>{let o="";for(let a=0;a<e.length;a++)o+=typeof e[a]=="string"?e[a]:e[a](r,t);return o}}var S1=new Intl.DateTimeFormat().resolvedOptions().timeZone;function M1(i,t){let e;return t=="UTC"||t=="Etc/UTC"?e=new Date(+i+i.getTimezoneOffset()*6e4):t==S1?e=i:(e=new Date(i.toLocaleString("en-US",{timeZone:t})),e.setMilliseconds(i.getMilliseconds())),e}var z_=i=>i%1==0,pu=[1,2,2.5,5],w1=Rl(10,-32,0,pu),V_=Rl(10,0,32,pu),b1=V_.filter(z_),Vr=w1.concat(V_),np=`
`,G_="{YYYY}",o_=np+G_,H_="{M}/{D}",El=np+H_,cu=El+"/{YY}",W_="{aa}",T1="{h}:{mm}",Qo=T1+W_,a_=np+Qo,l_=":{ss}",Ne=null;function X_(i){let t=i*1e3,e=t*60,n=e*60,s=n*24,r=s*30,o=s*365,l=(i==1?Rl(10,0,3,pu).filter(z_):Rl(10,-3,0,pu)).concat([t,t*5,t*10,t*15,t*30,e,e*5,e*10,e*15,e*30,n,n*2,n*3,n*4,n*6,n*8,n*12,s,s*2,s*3,s*4,s*5,s*6,s*7,s*8,s*9,s*10,s*15,r,r*2,r*3,r*4,r*6,o,o*2,o*5,o*10,o*25,o*50,o*100]),c=[[o,G_,Ne,Ne,Ne,Ne,Ne,Ne,1],[s*28,"{MMM}",o_,Ne,Ne,Ne,Ne,Ne,1],[s,H_,o_,Ne,Ne,Ne,Ne,Ne,1],[n,"{h}"+W_,cu,Ne,El,Ne,Ne,Ne,1],[e,Qo,cu,Ne,El,Ne,Ne,Ne,1],[t,l_,cu+" "+Qo,Ne,El+" "+Qo,Ne,a_,Ne,1],[i,l_+".{fff}",cu+" "+Qo,Ne,El+" "+Qo,Ne,a_,Ne,1]];function d(h){return(u,f,p,_,m,g)=>{let y=[],T=m>=o,v=m>=r&&m<o,M=h(p),b=He(M*i,3),x=Of(M.getFullYear(),T?0:M.getMonth(),v||T?1:M.getDate()),w=He(x*i,3);if(v||T){let O=v?m/r:0,P=T?m/o:0,L=b==w?b:He(Of(x.getFullYear()+P,x.getMonth()+O,1)*i,3),B=new Date(In(L/i)),G=B.getFullYear(),D=B.getMonth();for(let X=0;L<=_;X++){let Z=Of(G+P*X,D+O*X,1),W=Z-h(He(Z*i,3));L=He((+Z+W)*i,3),L<=_&&y.push(L)}}else{let O=m>=s?s:m,P=Pi(p)-Pi(b),L=w+P+_u(b-w,O);y.push(L);let B=h(L),G=B.getHours()+B.getMinutes()/e+B.getSeconds()/n,D=m/n,X=u.axes[f]._space,Z=g/X;for(;L=He(L+m,i==1?0:3),!(L>_);)if(D>1){let W=Pi(He(G+D,6))%24,q=h(L).getHours()-W;q>1&&(q=-1),L-=q*n,G=(G+D)%24;let Q=y[y.length-1];He((L-Q)/m,3)*Z>=.7&&y.push(L)}else y.push(L)}return y}}return[l,c,d]}var[E1,A1,C1]=X_(1),[R1,P1,I1]=X_(.001);Rl(2,-53,53,[1]);function c_(i,t){return i.map(e=>e.map((n,s)=>s==0||s==8||n==null?n:t(s==1||e[8]==0?n:e[1]+n)))}function h_(i,t){return(e,n,s,r,o)=>{let a=t.find(p=>o>=p[0])||t[t.length-1],l,c,d,h,u,f;return n.map(p=>{let _=i(p),m=_.getFullYear(),g=_.getMonth(),y=_.getDate(),T=_.getHours(),v=_.getMinutes(),M=_.getSeconds(),b=m!=l&&a[2]||g!=c&&a[3]||y!=d&&a[4]||T!=h&&a[5]||v!=u&&a[6]||M!=f&&a[7]||a[1];return l=m,c=g,d=y,h=T,u=v,f=M,b(_)})}}function L1(i,t){let e=ep(t);return(n,s,r,o,a)=>s.map(l=>e(i(l)))}function Of(i,t,e){return new Date(i,t,e)}function u_(i,t){return t(i)}var D1="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function d_(i,t){return(e,n,s,r)=>r==null?Zf:t(i(n))}function N1(i,t){let e=i.series[t];return e.width?e.stroke(i,t):e.points.width?e.points.stroke(i,t):null}function O1(i,t){return i.series[t].fill(i,t)}var U1={show:!0,live:!0,isolate:!1,mount:e1,markers:{show:!0,width:2,stroke:N1,fill:O1,dash:"solid"},idx:null,idxs:null,values:[]};function F1(i,t){let e=i.cursor.points,n=zi(),s=e.size(i,t);Ke(n,bl,s),Ke(n,Tl,s);let r=s/-2;Ke(n,"marginLeft",r),Ke(n,"marginTop",r);let o=e.width(i,t,s);return o&&Ke(n,"borderWidth",o),n}function B1(i,t){let e=i.series[t].points;return e._fill||e._stroke}function k1(i,t){let e=i.series[t].points;return e._stroke||e._fill}function z1(i,t){return i.series[t].points.size}var Uf=[0,0];function V1(i,t,e){return Uf[0]=t,Uf[1]=e,Uf}function hu(i,t,e,n=!0){return s=>{s.button==0&&(!n||s.target==t)&&e(s)}}function Ff(i,t,e,n=!0){return s=>{(!n||s.target==t)&&e(s)}}var G1={show:!0,x:!0,y:!0,lock:!1,move:V1,points:{one:!1,show:F1,size:z1,width:0,stroke:k1,fill:B1},bind:{mousedown:hu,mouseup:hu,click:hu,dblclick:hu,mousemove:Ff,mouseleave:Ff,mouseenter:Ff},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(i,t)=>{t.stopPropagation(),t.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(i,t,e,n,s)=>n-s,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},Y_={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},ip=wn({},Y_,{filter:L_}),q_=wn({},ip,{size:10}),$_=wn({},Y_,{show:!1}),sp='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',Z_="bold "+sp,J_=1.5,f_={show:!0,scale:"x",stroke:$f,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Z_,side:2,grid:ip,ticks:q_,border:$_,font:sp,lineGap:J_,rotate:0},H1="Value",W1="Time",p_={show:!0,scale:"x",auto:!1,sorted:1,min:Ge,max:-Ge,idxs:[]};function X1(i,t,e,n,s){return t.map(r=>r==null?"":Qf(r))}function Y1(i,t,e,n,s,r,o){let a=[],l=_r.get(s)||0;e=o?e:He(_u(e,s),l);for(let c=e;c<=n;c=He(c+s,l))a.push(Object.is(c,-0)?0:c);return a}function Hf(i,t,e,n,s,r,o){let a=[],l=i.scales[i.axes[t].scale].log,c=l==10?Hs:R_,d=Pi(c(e));s=ea(l,d),l==10&&(s=Vr[ts(s,Vr)]);let h=e,u=s*l;l==10&&(u=Vr[ts(u,Vr)]);do a.push(h),h=h+s,l==10&&!_r.has(h)&&(h=He(h,_r.get(s))),h>=u&&(s=h,u=s*l,l==10&&(u=Vr[ts(u,Vr)]));while(h<=n);return a}function q1(i,t,e,n,s,r,o){let l=i.scales[i.axes[t].scale].asinh,c=n>l?Hf(i,t,pi(l,e),n,s):[l],d=n>=0&&e<=0?[0]:[];return(e<-l?Hf(i,t,pi(l,-n),-e,s):[l]).reverse().map(u=>-u).concat(d,c)}var j_=/./,$1=/[12357]/,Z1=/[125]/,m_=/1/,Wf=(i,t,e,n)=>i.map((s,r)=>t==4&&s==0||r%n==0&&e.test(s.toExponential()[s<0?1:0])?s:null);function J1(i,t,e,n,s){let r=i.axes[e],o=r.scale,a=i.scales[o],l=i.valToPos,c=r._space,d=l(10,o),h=l(9,o)-d>=c?j_:l(7,o)-d>=c?$1:l(5,o)-d>=c?Z1:m_;if(h==m_){let u=Ln(l(1,o)-d);if(u<c)return Wf(t.slice().reverse(),a.distr,h,Vi(c/u)).reverse()}return Wf(t,a.distr,h,1)}function j1(i,t,e,n,s){let r=i.axes[e],o=r.scale,a=r._space,l=i.valToPos,c=Ln(l(1,o)-l(2,o));return c<a?Wf(t.slice().reverse(),3,j_,Vi(a/c)).reverse():t}function K1(i,t,e,n){return n==null?Zf:t==null?"":Qf(t)}var g_={show:!0,scale:"y",stroke:$f,space:30,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Z_,side:3,grid:ip,ticks:q_,border:$_,font:sp,lineGap:J_,rotate:0};function Q1(i,t){let e=3+(i||1)*2;return He(e*t,3)}function tE(i,t){let{scale:e,idxs:n}=i.series[0],s=i._data[0],r=i.valToPos(s[n[0]],e,!0),o=i.valToPos(s[n[1]],e,!0),a=Ln(o-r),l=i.series[t],c=a/(l.points.space*Re);return n[1]-n[0]<=c}var __={scale:null,auto:!0,sorted:0,min:Ge,max:-Ge},K_=(i,t,e,n,s)=>s,x_={show:!0,auto:!0,sorted:0,gaps:K_,alpha:1,facets:[wn({},__,{scale:"x"}),wn({},__,{scale:"y"})]},y_={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:K_,alpha:1,points:{show:tE,filter:null},values:null,min:Ge,max:-Ge,idxs:[],path:null,clip:null};function eE(i,t,e,n,s){return e/10}var Q_={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,max:null,dir:1,ori:0},nE=wn({},Q_,{time:!1,ori:1}),v_={};function tx(i,t){let e=v_[i];return e||(e={key:i,plots:[],sub(n){e.plots.push(n)},unsub(n){e.plots=e.plots.filter(s=>s!=n)},pub(n,s,r,o,a,l,c){for(let d=0;d<e.plots.length;d++)e.plots[d]!=s&&e.plots[d].pub(n,s,r,o,a,l,c)}},i!=null&&(v_[i]=e)),e}var sa=1,Xf=2;function Xr(i,t,e){let n=i.mode,s=i.series[t],r=n==2?i._data[t]:i._data,o=i.scales,a=i.bbox,l=r[0],c=n==2?r[1]:r[t],d=n==2?o[s.facets[0].scale]:o[i.series[0].scale],h=n==2?o[s.facets[1].scale]:o[s.scale],u=a.left,f=a.top,p=a.width,_=a.height,m=i.valToPosH,g=i.valToPosV;return d.ori==0?e(s,l,c,d,h,m,g,u,f,p,_,vu,oa,Mu,nx,sx):e(s,l,c,d,h,g,m,f,u,_,p,Su,aa,ap,ix,rx)}function rp(i,t){let e=0,n=0,s=Ae(i.bands,tp);for(let r=0;r<s.length;r++){let o=s[r];o.series[0]==t?e=o.dir:o.series[1]==t&&(o.dir==1?n|=1:n|=2)}return[e,n==1?-1:n==2?1:n==3?2:0]}function iE(i,t,e,n,s){let r=i.mode,o=i.series[t],a=r==2?o.facets[1].scale:o.scale,l=i.scales[a];return s==-1?l.min:s==1?l.max:l.distr==3?l.dir==1?l.min:l.max:0}function Ws(i,t,e,n,s,r){return Xr(i,t,(o,a,l,c,d,h,u,f,p,_,m)=>{let g=o.pxRound,y=c.dir*(c.ori==0?1:-1),T=c.ori==0?oa:aa,v,M;y==1?(v=e,M=n):(v=n,M=e);let b=g(h(a[v],c,_,f)),x=g(u(l[v],d,m,p)),w=g(h(a[M],c,_,f)),O=g(u(r==1?d.max:d.min,d,m,p)),P=new Path2D(s);return T(P,w,O),T(P,b,O),T(P,b,x),P})}function yu(i,t,e,n,s,r){let o=null;if(i.length>0){o=new Path2D;let a=t==0?Mu:ap,l=e;for(let h=0;h<i.length;h++){let u=i[h];if(u[1]>u[0]){let f=u[0]-l;f>0&&a(o,l,n,f,n+r),l=u[1]}}let c=e+s-l,d=10;c>0&&a(o,l,n-d/2,c,n+r+d)}return o}function sE(i,t,e){let n=i[i.length-1];n&&n[0]==t?n[1]=e:i.push([t,e])}function op(i,t,e,n,s,r,o){let a=[],l=i.length;for(let c=s==1?e:n;c>=e&&c<=n;c+=s)if(t[c]===null){let h=c,u=c;if(s==1)for(;++c<=n&&t[c]===null;)u=c;else for(;--c>=e&&t[c]===null;)u=c;let f=r(i[h]),p=u==h?f:r(i[u]),_=h-s;f=o<=0&&_>=0&&_<l?r(i[_]):f;let g=u+s;p=o>=0&&g>=0&&g<l?r(i[g]):p,p>=f&&a.push([f,p])}return a}function S_(i){return i==0?I_:i==1?In:t=>zr(t,i)}function ex(i){let t=i==0?vu:Su,e=i==0?(s,r,o,a,l,c)=>{s.arcTo(r,o,a,l,c)}:(s,r,o,a,l,c)=>{s.arcTo(o,r,l,a,c)},n=i==0?(s,r,o,a,l)=>{s.rect(r,o,a,l)}:(s,r,o,a,l)=>{s.rect(o,r,l,a)};return(s,r,o,a,l,c=0,d=0)=>{c==0&&d==0?n(s,r,o,a,l):(c=es(c,a/2,l/2),d=es(d,a/2,l/2),t(s,r+c,o),e(s,r+a,o,r+a,o+l,c),e(s,r+a,o+l,r,o+l,d),e(s,r,o+l,r,o,d),e(s,r,o,r+a,o,c),s.closePath())}}var vu=(i,t,e)=>{i.moveTo(t,e)},Su=(i,t,e)=>{i.moveTo(e,t)},oa=(i,t,e)=>{i.lineTo(t,e)},aa=(i,t,e)=>{i.lineTo(e,t)},Mu=ex(0),ap=ex(1),nx=(i,t,e,n,s,r)=>{i.arc(t,e,n,s,r)},ix=(i,t,e,n,s,r)=>{i.arc(e,t,n,s,r)},sx=(i,t,e,n,s,r,o)=>{i.bezierCurveTo(t,e,n,s,r,o)},rx=(i,t,e,n,s,r,o)=>{i.bezierCurveTo(e,t,s,n,o,r)};function ox(i){return(t,e,n,s,r)=>Xr(t,e,(o,a,l,c,d,h,u,f,p,_,m)=>{let{pxRound:g,points:y}=o,T,v;c.ori==0?(T=vu,v=nx):(T=Su,v=ix);let M=He(y.width*Re,3),b=(y.size-y.width)/2*Re,x=He(b*2,3),w=new Path2D,O=new Path2D,{left:P,top:L,width:B,height:G}=t.bbox;Mu(O,P-x,L-x,B+x*2,G+x*2);let D=X=>{if(l[X]!=null){let Z=g(h(a[X],c,_,f)),W=g(u(l[X],d,m,p));T(w,Z+b,W),v(w,Z,W,b,0,uu*2)}};if(r)r.forEach(D);else for(let X=n;X<=s;X++)D(X);return{stroke:M>0?w:null,fill:w,clip:O,flags:sa|Xf}})}function ax(i){return(t,e,n,s,r,o)=>{n!=s&&(r!=n&&o!=n&&i(t,e,n),r!=s&&o!=s&&i(t,e,s),i(t,e,o))}}var rE=ax(oa),oE=ax(aa);function lx(i){let t=Ae(i?.alignGaps,0);return(e,n,s,r)=>Xr(e,n,(o,a,l,c,d,h,u,f,p,_,m)=>{[s,r]=mu(l,s,r);let g=o.pxRound,y=G=>g(h(G,c,_,f)),T=G=>g(u(G,d,m,p)),v,M;c.ori==0?(v=oa,M=rE):(v=aa,M=oE);let b=c.dir*(c.ori==0?1:-1),x={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:sa},w=x.stroke,O=!1;if(r-s>=_*4){let G=ht=>e.posToVal(ht,c.key,!0),D=null,X=null,Z,W,at,k=y(a[b==1?s:r]),q=y(a[s]),Q=y(a[r]),lt=G(b==1?q+1:Q-1);for(let ht=b==1?s:r;ht>=s&&ht<=r;ht+=b){let et=a[ht],xt=(b==1?et<lt:et>lt)?k:y(et),Ct=l[ht];xt==k?Ct!=null?(W=Ct,D==null?(v(w,xt,T(W)),Z=D=X=W):W<D?D=W:W>X&&(X=W)):Ct===null&&(O=!0):(D!=null&&M(w,k,T(D),T(X),T(Z),T(W)),Ct!=null?(W=Ct,v(w,xt,T(W)),D=X=Z=W):(D=X=null,Ct===null&&(O=!0)),k=xt,lt=G(k+b))}D!=null&&D!=X&&at!=k&&M(w,k,T(D),T(X),T(Z),T(W))}else for(let G=b==1?s:r;G>=s&&G<=r;G+=b){let D=l[G];D===null?O=!0:D!=null&&v(w,y(a[G]),T(D))}let[L,B]=rp(e,n);if(o.fill!=null||L!=0){let G=x.fill=new Path2D(w),D=o.fillTo(e,n,o.min,o.max,L),X=T(D),Z=y(a[s]),W=y(a[r]);b==-1&&([W,Z]=[Z,W]),v(G,W,X),v(G,Z,X)}if(!o.spanGaps){let G=[];O&&G.push(...op(a,l,s,r,b,y,t)),x.gaps=G=o.gaps(e,n,s,r,G),x.clip=yu(G,c.ori,f,p,_,m)}return B!=0&&(x.band=B==2?[Ws(e,n,s,r,w,-1),Ws(e,n,s,r,w,1)]:Ws(e,n,s,r,w,B)),x})}function aE(i){let t=Ae(i.align,1),e=Ae(i.ascDesc,!1),n=Ae(i.alignGaps,0),s=Ae(i.extend,!1);return(r,o,a,l)=>Xr(r,o,(c,d,h,u,f,p,_,m,g,y,T)=>{[a,l]=mu(h,a,l);let v=c.pxRound,{left:M,width:b}=r.bbox,x=q=>v(p(q,u,y,m)),w=q=>v(_(q,f,T,g)),O=u.ori==0?oa:aa,P={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:sa},L=P.stroke,B=u.dir*(u.ori==0?1:-1),G=w(h[B==1?a:l]),D=x(d[B==1?a:l]),X=D,Z=D;s&&t==-1&&(Z=M,O(L,Z,G)),O(L,D,G);for(let q=B==1?a:l;q>=a&&q<=l;q+=B){let Q=h[q];if(Q==null)continue;let lt=x(d[q]),ht=w(Q);t==1?O(L,lt,G):O(L,X,ht),O(L,lt,ht),G=ht,X=lt}let W=X;s&&t==1&&(W=M+b,O(L,W,G));let[at,k]=rp(r,o);if(c.fill!=null||at!=0){let q=P.fill=new Path2D(L),Q=c.fillTo(r,o,c.min,c.max,at),lt=w(Q);O(q,W,lt),O(q,Z,lt)}if(!c.spanGaps){let q=[];q.push(...op(d,h,a,l,B,x,n));let Q=c.width*Re/2,lt=e||t==1?Q:-Q,ht=e||t==-1?-Q:Q;q.forEach(et=>{et[0]+=lt,et[1]+=ht}),P.gaps=q=c.gaps(r,o,a,l,q),P.clip=yu(q,u.ori,m,g,y,T)}return k!=0&&(P.band=k==2?[Ws(r,o,a,l,L,-1),Ws(r,o,a,l,L,1)]:Ws(r,o,a,l,L,k)),P})}function M_(i,t,e,n,s,r,o=Ge){if(i.length>1){let a=null;for(let l=0,c=1/0;l<i.length;l++)if(t[l]!==void 0){if(a!=null){let d=Ln(i[l]-i[a]);d<c&&(c=d,o=Ln(e(i[l],n,s,r)-e(i[a],n,s,r)))}a=l}}return o}function lE(i){i=i||Cl;let t=Ae(i.size,[.6,Ge,1]),e=i.align||0,n=i.gap||0,s=i.radius;s=s==null?[0,0]:typeof s=="number"?[s,0]:s;let r=Me(s),o=1-t[0],a=Ae(t[1],Ge),l=Ae(t[2],1),c=Ae(i.disp,Cl),d=Ae(i.each,f=>{}),{fill:h,stroke:u}=c;return(f,p,_,m)=>Xr(f,p,(g,y,T,v,M,b,x,w,O,P,L)=>{let B=g.pxRound,G=e,D=n*Re,X=a*Re,Z=l*Re,W,at;v.ori==0?[W,at]=r(f,p):[at,W]=r(f,p);let k=v.dir*(v.ori==0?1:-1),q=v.ori==0?Mu:ap,Q=v.ori==0?d:(Pt,Kt,ce,bt,Ve,Ht,Jt)=>{d(Pt,Kt,ce,Ve,bt,Jt,Ht)},lt=Ae(f.bands,tp).find(Pt=>Pt.series[0]==p),ht=lt!=null?lt.dir:0,et=g.fillTo(f,p,g.min,g.max,ht),mt=B(x(et,M,L,O)),xt,Ct,wt,$t=P,le=B(g.width*Re),Yt=!1,ge=null,de=null,oe=null,Qe=null;h!=null&&(le==0||u!=null)&&(Yt=!0,ge=h.values(f,p,_,m),de=new Map,new Set(ge).forEach(Pt=>{Pt!=null&&de.set(Pt,new Path2D)}),le>0&&(oe=u.values(f,p,_,m),Qe=new Map,new Set(oe).forEach(Pt=>{Pt!=null&&Qe.set(Pt,new Path2D)})));let{x0:Xe,size:mn}=c;if(Xe!=null&&mn!=null){G=1,y=Xe.values(f,p,_,m),Xe.unit==2&&(y=y.map(ce=>f.posToVal(w+ce*P,v.key,!0)));let Pt=mn.values(f,p,_,m);mn.unit==2?Ct=Pt[0]*P:Ct=b(Pt[0],v,P,w)-b(0,v,P,w),$t=M_(y,T,b,v,P,w,$t),wt=$t-Ct+D}else $t=M_(y,T,b,v,P,w,$t),wt=$t*o+D,Ct=$t-wt;wt<1&&(wt=0),le>=Ct/2&&(le=0),wt<5&&(B=I_);let Be=wt>0,Nn=$t-wt-(Be?le:0);Ct=B(Gf(Nn,Z,X)),xt=(G==0?Ct/2:G==k?0:Ct)-G*k*((G==0?D/2:0)+(Be?le/2:0));let we={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},bn=Yt?null:new Path2D,an=null;if(lt!=null)an=f.data[lt.series[1]];else{let{y0:Pt,y1:Kt}=c;Pt!=null&&Kt!=null&&(T=Kt.values(f,p,_,m),an=Pt.values(f,p,_,m))}let gn=W*Ct,V=at*Ct;for(let Pt=k==1?_:m;Pt>=_&&Pt<=m;Pt+=k){let Kt=T[Pt];if(Kt==null)continue;if(an!=null){let $=an[Pt]??0;if(Kt-$==0)continue;mt=x($,M,L,O)}let ce=v.distr!=2||c!=null?y[Pt]:Pt,bt=b(ce,v,P,w),Ve=x(Ae(Kt,et),M,L,O),Ht=B(bt-xt),Jt=B(pi(Ve,mt)),I=B(es(Ve,mt)),E=Jt-I;if(Kt!=null){let $=Kt<0?V:gn,dt=Kt<0?gn:V;Yt?(le>0&&oe[Pt]!=null&&q(Qe.get(oe[Pt]),Ht,I+Pi(le/2),Ct,pi(0,E-le),$,dt),ge[Pt]!=null&&q(de.get(ge[Pt]),Ht,I+Pi(le/2),Ct,pi(0,E-le),$,dt)):q(bn,Ht,I+Pi(le/2),Ct,pi(0,E-le),$,dt),Q(f,p,Pt,Ht-le/2,I,Ct+le,E)}}return le>0?we.stroke=Yt?Qe:bn:Yt||(we._fill=g.width==0?g._fill:g._stroke??g._fill,we.width=0),we.fill=Yt?de:bn,we})}function cE(i,t){let e=Ae(t?.alignGaps,0);return(n,s,r,o)=>Xr(n,s,(a,l,c,d,h,u,f,p,_,m,g)=>{[r,o]=mu(c,r,o);let y=a.pxRound,T=W=>y(u(W,d,m,p)),v=W=>y(f(W,h,g,_)),M,b,x;d.ori==0?(M=vu,x=oa,b=sx):(M=Su,x=aa,b=rx);let w=d.dir*(d.ori==0?1:-1),O=T(l[w==1?r:o]),P=O,L=[],B=[];for(let W=w==1?r:o;W>=r&&W<=o;W+=w)if(c[W]!=null){let k=l[W],q=T(k);L.push(P=q),B.push(v(c[W]))}let G={stroke:i(L,B,M,x,b,y),fill:null,clip:null,band:null,gaps:null,flags:sa},D=G.stroke,[X,Z]=rp(n,s);if(a.fill!=null||X!=0){let W=G.fill=new Path2D(D),at=a.fillTo(n,s,a.min,a.max,X),k=v(at);x(W,P,k),x(W,O,k)}if(!a.spanGaps){let W=[];W.push(...op(l,c,r,o,w,T,e)),G.gaps=W=a.gaps(n,s,r,o,W),G.clip=yu(W,d.ori,p,_,m,g)}return Z!=0&&(G.band=Z==2?[Ws(n,s,r,o,D,-1),Ws(n,s,r,o,D,1)]:Ws(n,s,r,o,D,Z)),G})}function hE(i){return cE(uE,i)}function uE(i,t,e,n,s,r){let o=i.length;if(o<2)return null;let a=new Path2D;if(e(a,i[0],t[0]),o==2)n(a,i[1],t[1]);else{let l=Array(o),c=Array(o-1),d=Array(o-1),h=Array(o-1);for(let u=0;u<o-1;u++)d[u]=t[u+1]-t[u],h[u]=i[u+1]-i[u],c[u]=d[u]/h[u];l[0]=c[0];for(let u=1;u<o-1;u++)c[u]===0||c[u-1]===0||c[u-1]>0!=c[u]>0?l[u]=0:(l[u]=3*(h[u-1]+h[u])/((2*h[u]+h[u-1])/c[u-1]+(h[u]+2*h[u-1])/c[u]),isFinite(l[u])||(l[u]=0));l[o-1]=c[o-2];for(let u=0;u<o-1;u++)s(a,i[u]+h[u]/3,t[u]+l[u]*h[u]/3,i[u+1]-h[u]/3,t[u+1]-l[u+1]*h[u]/3,i[u+1],t[u+1])}return a}var Yf=new Set;function w_(){for(let i of Yf)i.syncRect(!0)}ra&&(Hr(XT,ta,w_),Hr(YT,ta,w_,!0),Hr(du,ta,()=>{Gn.pxRatio=Re}));var dE=lx(),fE=ox();function b_(i,t,e,n){return(n?[i[0],i[1]].concat(i.slice(2)):[i[0]].concat(i.slice(1))).map((r,o)=>qf(r,o,t,e))}function pE(i,t){return i.map((e,n)=>n==0?{}:wn({},t,e))}function qf(i,t,e,n){return wn({},t==0?e:n,i)}function cx(i,t,e){return t==null?na:[t,e]}var mE=cx;function gE(i,t,e){return t==null?na:fu(t,e,Kf,!0)}function hx(i,t,e,n){return t==null?na:gu(t,e,i.scales[n].log,!1)}var _E=hx;function ux(i,t,e,n){return t==null?na:jf(t,e,i.scales[n].log,!1)}var xE=ux;function yE(i,t,e,n,s){let r=pi(n_(i),n_(t)),o=t-i,a=ts(s/n*o,e);do{let l=e[a],c=n*l/o;if(c>=s&&r+(l<5?_r.get(l):0)<=17)return[l,c]}while(++a<e.length);return[0,0]}function T_(i){let t,e;return i=i.replace(/(\d+)px/,(n,s)=>(t=In((e=+s)*Re))+"px"),[i,t,e]}function vE(i){i.show&&[i.font,i.labelFont].forEach(t=>{let e=He(t[2]*Re,1);t[0]=t[0].replace(/[0-9.]+px/,e+"px"),t[1]=e})}function Gn(i,t,e){let n={mode:Ae(i.mode,1)},s=n.mode;function r(S,A,N,F){let Y=A.valToPct(S);return F+N*(A.dir==-1?1-Y:Y)}function o(S,A,N,F){let Y=A.valToPct(S);return F+N*(A.dir==-1?Y:1-Y)}function a(S,A,N,F){return A.ori==0?r(S,A,N,F):o(S,A,N,F)}n.valToPosH=r,n.valToPosV=o;let l=!1;n.status=0;let c=n.root=zi(AT);if(i.id!=null&&(c.id=i.id),Ri(c,i.class),i.title){let S=zi(PT,c);S.textContent=i.title}let d=Qi("canvas"),h=n.ctx=d.getContext("2d"),u=zi(IT,c);Hr("click",u,S=>{S.target===p&&($e!=to||tn!=eo)&&Hn.click(n,S)},!0);let f=n.under=zi(LT,u);u.appendChild(d);let p=n.over=zi(DT,u);i=ia(i);let _=+Ae(i.pxAlign,1),m=S_(_);(i.plugins||[]).forEach(S=>{S.opts&&(i=S.opts(n,i)||i)});let g=i.ms||.001,y=n.series=s==1?b_(i.series||[],p_,y_,!1):pE(i.series||[null],x_),T=n.axes=b_(i.axes||[],f_,g_,!0),v=n.scales={},M=n.bands=i.bands||[];M.forEach(S=>{S.fill=Me(S.fill||null),S.dir=Ae(S.dir,-1)});let b=s==2?y[1].facets[0].scale:y[0].scale,x={axes:bs,series:xe},w=(i.drawOrder||["axes","series"]).map(S=>x[S]);function O(S){let A=S.distr==3?N=>Hs(N>0?N:S.clamp(n,N,S.min,S.max,S.key)):S.distr==4?N=>Nf(N,S.asinh):S.distr==100?N=>S.fwd(N):N=>N;return N=>{let F=A(N),{_min:Y,_max:K}=S,ct=K-Y;return(F-Y)/ct}}function P(S){let A=v[S];if(A==null){let N=(i.scales||Cl)[S]||Cl;if(N.from!=null){P(N.from);let F=wn({},v[N.from],N,{key:S});F.valToPct=O(F),v[S]=F}else{A=v[S]=wn({},S==b?Q_:nE,N),A.key=S;let F=A.time,Y=A.range,K=gr(Y);if((S!=b||s==2&&!F)&&(K&&(Y[0]==null||Y[1]==null)&&(Y={min:Y[0]==null?Q0:{mode:1,hard:Y[0],soft:Y[0]},max:Y[1]==null?Q0:{mode:1,hard:Y[1],soft:Y[1]}},K=!1),!K&&xu(Y))){let ct=Y;Y=(ft,vt,Ot)=>vt==null?na:fu(vt,Ot,ct)}A.range=Me(Y||(F?mE:S==b?A.distr==3?_E:A.distr==4?xE:cx:A.distr==3?hx:A.distr==4?ux:gE)),A.auto=Me(K?!1:A.auto),A.clamp=Me(A.clamp||eE),A._min=A._max=null,A.valToPct=O(A)}}}P("x"),P("y"),s==1&&y.forEach(S=>{P(S.scale)}),T.forEach(S=>{P(S.scale)});for(let S in i.scales)P(S);let L=v[b],B=L.distr,G,D;L.ori==0?(Ri(c,CT),G=r,D=o):(Ri(c,RT),G=o,D=r);let X={};for(let S in v){let A=v[S];(A.min!=null||A.max!=null)&&(X[S]={min:A.min,max:A.max},A.min=A.max=null)}let Z=i.tzDate||(S=>new Date(In(S/g))),W=i.fmtDate||ep,at=g==1?C1(Z):I1(Z),k=h_(Z,c_(g==1?A1:P1,W)),q=d_(Z,u_(D1,W)),Q=[],lt=n.legend=wn({},U1,i.legend),ht=n.cursor=wn({},G1,{drag:{y:s==2}},i.cursor),et=lt.show,mt=ht.show,xt=lt.markers;lt.idxs=Q,xt.width=Me(xt.width),xt.dash=Me(xt.dash),xt.stroke=Me(xt.stroke),xt.fill=Me(xt.fill);let Ct,wt,$t,le=[],Yt=[],ge,de=!1,oe={};if(lt.live){let S=y[1]?y[1].values:null;de=S!=null,ge=de?S(n,1,0):{_:0};for(let A in ge)oe[A]=Zf}if(et)if(Ct=Qi("table",kT,c),$t=Qi("tbody",null,Ct),lt.mount(n,Ct),de){wt=Qi("thead",null,Ct,$t);let S=Qi("tr",null,wt);Qi("th",null,S);for(var Qe in ge)Qi("th",z0,S).textContent=Qe}else Ri(Ct,VT),lt.live&&Ri(Ct,zT);let Xe={show:!0},mn={show:!1};function Be(S,A){if(A==0&&(de||!lt.live||s==2))return na;let N=[],F=Qi("tr",GT,$t,$t.childNodes[A]);Ri(F,S.class),S.show||Ri(F,Gr);let Y=Qi("th",null,F);if(xt.show){let ft=zi(HT,Y);if(A>0){let vt=xt.width(n,A);vt&&(ft.style.border=vt+"px "+xt.dash(n,A)+" "+xt.stroke(n,A)),ft.style.background=xt.fill(n,A)}}let K=zi(z0,Y);S.label instanceof HTMLElement?K.appendChild(S.label):K.textContent=S.label,A>0&&(xt.show||(K.style.color=S.width>0?xt.stroke(n,A):xt.fill(n,A)),we("click",Y,ft=>{if(ht._lock)return;ee(ft);let vt=y.indexOf(S);if((ft.ctrlKey||ft.metaKey)!=lt.isolate){let Ot=y.some((Ut,kt)=>kt>0&&kt!=vt&&Ut.show);y.forEach((Ut,kt)=>{kt>0&&rs(kt,Ot?kt==vt?Xe:mn:Xe,!0,vn.setSeries)})}else rs(vt,{show:!S.show},!0,vn.setSeries)},!1),ne&&we(W0,Y,ft=>{ht._lock||(ee(ft),rs(y.indexOf(S),io,!0,vn.setSeries))},!1));for(var ct in ge){let ft=Qi("td",WT,F);ft.textContent="--",N.push(ft)}return[F,N]}let Nn=new Map;function we(S,A,N,F=!0){let Y=Nn.get(A)||{},K=ht.bind[S](n,A,N,F);K&&(Hr(S,A,Y[S]=K),Nn.set(A,Y))}function bn(S,A,N){let F=Nn.get(A)||{};for(let Y in F)(S==null||Y==S)&&(Vf(Y,A,F[Y]),delete F[Y]);S==null&&Nn.delete(A)}let an=0,gn=0,V=0,Pt=0,Kt=0,ce=0,bt=Kt,Ve=ce,Ht=V,Jt=Pt,I=0,E=0,$=0,dt=0;n.bbox={};let ot=!1,_t=!1,yt=!1,nt=!1,st=!1,pt=!1;function z(S,A,N){(N||S!=n.width||A!=n.height)&&rt(S,A),fe(!1),yt=!0,_t=!0,Jn()}function rt(S,A){n.width=an=V=S,n.height=gn=Pt=A,Kt=ce=0,Mt(),qt();let N=n.bbox;I=N.left=zr(Kt*Re,.5),E=N.top=zr(ce*Re,.5),$=N.width=zr(V*Re,.5),dt=N.height=zr(Pt*Re,.5)}let it=3;function Tt(){let S=!1,A=0;for(;!S;){A++;let N=jr(A),F=ss(A);S=A==it||N&&F,S||(rt(n.width,n.height),_t=!0)}}function gt({width:S,height:A}){z(S,A)}n.setSize=gt;function Mt(){let S=!1,A=!1,N=!1,F=!1;T.forEach((Y,K)=>{if(Y.show&&Y._show){let{side:ct,_size:ft}=Y,vt=ct%2,Ot=Y.label!=null?Y.labelSize:0,Ut=ft+Ot;Ut>0&&(vt?(V-=Ut,ct==3?(Kt+=Ut,F=!0):N=!0):(Pt-=Ut,ct==0?(ce+=Ut,S=!0):A=!0))}}),ns[0]=S,ns[1]=N,ns[2]=A,ns[3]=F,V-=Gi[1]+Gi[3],Kt+=Gi[3],Pt-=Gi[2]+Gi[0],ce+=Gi[0]}function qt(){let S=Kt+V,A=ce+Pt,N=Kt,F=ce;function Y(K,ct){switch(K){case 1:return S+=ct,S-ct;case 2:return A+=ct,A-ct;case 3:return N-=ct,N+ct;case 0:return F-=ct,F+ct}}T.forEach((K,ct)=>{if(K.show&&K._show){let ft=K.side;K._pos=Y(ft,K._size),K.label!=null&&(K._lpos=Y(ft,K.labelSize))}})}if(ht.dataIdx==null){let S=ht.hover,A=S.skip=new Set(S.skip??[]);A.add(void 0);let N=S.prox=Me(S.prox),F=S.bias??=0;ht.dataIdx=(Y,K,ct,ft)=>{if(K==0)return ct;let vt=ct,Ot=N(Y,K,ct,ft)??Ge,Ut=Ot>=0&&Ot<Ge,kt=L.ori==0?V:Pt,ae=ht.left,Ce=t[0],be=t[K];if(A.has(be[ct])){vt=null;let ye=null,Qt=null,Zt;if(F==0||F==-1)for(Zt=ct;ye==null&&Zt-- >0;)A.has(be[Zt])||(ye=Zt);if(F==0||F==1)for(Zt=ct;Qt==null&&Zt++<be.length;)A.has(be[Zt])||(Qt=Zt);if(ye!=null||Qt!=null)if(Ut){let Je=ye==null?-1/0:G(Ce[ye],L,kt,0),hn=Qt==null?1/0:G(Ce[Qt],L,kt,0),Bn=ae-Je,ke=hn-ae;Bn<=ke?Bn<=Ot&&(vt=ye):ke<=Ot&&(vt=Qt)}else vt=Qt==null?ye:ye==null?Qt:ct-ye<=Qt-ct?ye:Qt}else Ut&&Ln(ae-G(Ce[ct],L,kt,0))>Ot&&(vt=null);return vt}}let ee=S=>{ht.event=S};ht.idxs=Q,ht._lock=!1;let ut=ht.points;ut.show=Me(ut.show),ut.size=Me(ut.size),ut.stroke=Me(ut.stroke),ut.width=Me(ut.width),ut.fill=Me(ut.fill);let zt=n.focus=wn({},i.focus||{alpha:.3},ht.focus),ne=zt.prox>=0,Rt=ne&&ut.one,ue=[],qe=[],ii=[];function ca(S,A){let N=ut.show(n,A);if(N instanceof HTMLElement)return Ri(N,BT),Ri(N,S.class),ys(N,-10,-10,V,Pt),p.insertBefore(N,ue[A]),N}function $r(S,A){if(s==1||A>0){let N=s==1&&v[S.scale].time,F=S.value;S.value=N?r_(F)?d_(Z,u_(F,W)):F||q:F||K1,S.label=S.label||(N?W1:H1)}if(Rt||A>0){S.width=S.width==null?1:S.width,S.paths=S.paths||dE||n1,S.fillTo=Me(S.fillTo||iE),S.pxAlign=+Ae(S.pxAlign,_),S.pxRound=S_(S.pxAlign),S.stroke=Me(S.stroke||null),S.fill=Me(S.fill||null),S._stroke=S._fill=S._paths=S._focus=null;let N=Q1(pi(1,S.width),1),F=S.points=wn({},{size:N,width:pi(1,N*.2),stroke:S.stroke,space:N*2,paths:fE,_stroke:null,_fill:null},S.points);F.show=Me(F.show),F.filter=Me(F.filter),F.fill=Me(F.fill),F.stroke=Me(F.stroke),F.paths=Me(F.paths),F.pxAlign=S.pxAlign}if(et){let N=Be(S,A);le.splice(A,0,N[0]),Yt.splice(A,0,N[1]),lt.values.push(null)}if(mt){Q.splice(A,0,null);let N=null;Rt?A==0&&(N=ca(S,A)):A>0&&(N=ca(S,A)),ue.splice(A,0,N),qe.splice(A,0,0),ii.splice(A,0,0)}Fn("addSeries",A)}function Bu(S,A){A=A??y.length,S=s==1?qf(S,A,p_,y_):qf(S,A,{},x_),y.splice(A,0,S),$r(y[A],A)}n.addSeries=Bu;function Ol(S){if(y.splice(S,1),et){lt.values.splice(S,1),Yt.splice(S,1);let A=le.splice(S,1)[0];bn(null,A.firstChild),A.remove()}mt&&(Q.splice(S,1),ue.splice(S,1)[0].remove(),qe.splice(S,1),ii.splice(S,1)),Fn("delSeries",S)}n.delSeries=Ol;let ns=[!1,!1,!1,!1];function Ss(S,A){if(S._show=S.show,S.show){let N=S.side%2,F=v[S.scale];F==null&&(S.scale=N?y[1].scale:b,F=v[S.scale]);let Y=F.time;S.size=Me(S.size),S.space=Me(S.space),S.rotate=Me(S.rotate),gr(S.incrs)&&S.incrs.forEach(ct=>{!_r.has(ct)&&_r.set(ct,N_(ct))}),S.incrs=Me(S.incrs||(F.distr==2?b1:Y?g==1?E1:R1:Vr)),S.splits=Me(S.splits||(Y&&F.distr==1?at:F.distr==3?Hf:F.distr==4?q1:Y1)),S.stroke=Me(S.stroke),S.grid.stroke=Me(S.grid.stroke),S.ticks.stroke=Me(S.ticks.stroke),S.border.stroke=Me(S.border.stroke);let K=S.values;S.values=gr(K)&&!gr(K[0])?Me(K):Y?gr(K)?h_(Z,c_(K,W)):r_(K)?L1(Z,K):K||k:K||X1,S.filter=Me(S.filter||(F.distr>=3&&F.log==10?J1:F.distr==3&&F.log==2?j1:L_)),S.font=T_(S.font),S.labelFont=T_(S.labelFont),S._size=S.size(n,null,A,0),S._space=S._rotate=S._incrs=S._found=S._splits=S._values=null,S._size>0&&(ns[A]=!0,S._el=zi(NT,u))}}function Ms(S,A,N,F){let[Y,K,ct,ft]=N,vt=A%2,Ot=0;return vt==0&&(ft||K)&&(Ot=A==0&&!Y||A==2&&!ct?In(f_.size/3):0),vt==1&&(Y||ct)&&(Ot=A==1&&!K||A==3&&!ft?In(g_.size/2):0),Ot}let ha=n.padding=(i.padding||[Ms,Ms,Ms,Ms]).map(S=>Me(Ae(S,Ms))),Gi=n._padding=ha.map((S,A)=>S(n,A,ns,0)),ln,fn=null,pn=null,is=s==1?y[0].idxs:null,vi=null,Xs=!1;function ua(S,A){if(t=S??[],n.data=n._data=t,s==2){ln=0;for(let N=1;N<y.length;N++)ln+=t[N][0].length}else{t.length==0&&(n.data=n._data=t=[[]]),vi=t[0],ln=vi.length;let N=t;if(B==2){N=t.slice();let F=N[0]=Array(ln);for(let Y=0;Y<ln;Y++)F[Y]=Y}n._data=t=N}if(fe(!0),Fn("setData"),B==2&&(yt=!0),A!==!1){let N=L;N.auto(n,Xs)?da():$s(b,N.min,N.max),nt=nt||ht.left>=0,pt=!0,Jn()}}n.setData=ua;function da(){Xs=!0;let S,A;s==1&&(ln>0?(fn=is[0]=0,pn=is[1]=ln-1,S=t[0][fn],A=t[0][pn],B==2?(S=fn,A=pn):S==A&&(B==3?[S,A]=gu(S,S,L.log,!1):B==4?[S,A]=jf(S,S,L.log,!1):L.time?A=S+In(86400/g):[S,A]=fu(S,A,Kf,!0))):(fn=is[0]=S=null,pn=is[1]=A=null)),$s(b,S,A)}let Zr,Ys,Jr,C,H,tt,J,j,Et,Dt;function At(S,A,N,F,Y,K){S??=G0,N??=tp,F??="butt",Y??=G0,K??="round",S!=Zr&&(h.strokeStyle=Zr=S),Y!=Ys&&(h.fillStyle=Ys=Y),A!=Jr&&(h.lineWidth=Jr=A),K!=H&&(h.lineJoin=H=K),F!=tt&&(h.lineCap=tt=F),N!=C&&h.setLineDash(C=N)}function Nt(S,A,N,F){A!=Ys&&(h.fillStyle=Ys=A),S!=J&&(h.font=J=S),N!=j&&(h.textAlign=j=N),F!=Et&&(h.textBaseline=Et=F)}function Gt(S,A,N,F,Y=0){if(F.length>0&&S.auto(n,Xs)&&(A==null||A.min==null)){let K=Ae(fn,0),ct=Ae(pn,F.length-1),ft=N.min==null?JT(F,K,ct,Y,S.distr==3):[N.min,N.max];S.min=es(S.min,N.min=ft[0]),S.max=pi(S.max,N.max=ft[1])}}let se={min:null,max:null};function _e(){for(let F in v){let Y=v[F];X[F]==null&&(Y.min==null||X[b]!=null&&Y.auto(n,Xs))&&(X[F]=se)}for(let F in v){let Y=v[F];X[F]==null&&Y.from!=null&&X[Y.from]!=null&&(X[F]=se)}X[b]!=null&&fe(!0);let S={};for(let F in X){let Y=X[F];if(Y!=null){let K=S[F]=ia(v[F],r1);if(Y.min!=null)wn(K,Y);else if(F!=b||s==2)if(ln==0&&K.from==null){let ct=K.range(n,null,null,F);K.min=ct[0],K.max=ct[1]}else K.min=Ge,K.max=-Ge}}if(ln>0){y.forEach((F,Y)=>{if(s==1){let K=F.scale,ct=X[K];if(ct==null)return;let ft=S[K];if(Y==0){let vt=ft.range(n,ft.min,ft.max,K);ft.min=vt[0],ft.max=vt[1],fn=ts(ft.min,t[0]),pn=ts(ft.max,t[0]),pn-fn>1&&(t[0][fn]<ft.min&&fn++,t[0][pn]>ft.max&&pn--),F.min=vi[fn],F.max=vi[pn]}else F.show&&F.auto&&Gt(ft,ct,F,t[Y],F.sorted);F.idxs[0]=fn,F.idxs[1]=pn}else if(Y>0&&F.show&&F.auto){let[K,ct]=F.facets,ft=K.scale,vt=ct.scale,[Ot,Ut]=t[Y],kt=S[ft],ae=S[vt];kt!=null&&Gt(kt,X[ft],K,Ot,K.sorted),ae!=null&&Gt(ae,X[vt],ct,Ut,ct.sorted),F.min=ct.min,F.max=ct.max}});for(let F in S){let Y=S[F],K=X[F];if(Y.from==null&&(K==null||K.min==null)){let ct=Y.range(n,Y.min==Ge?null:Y.min,Y.max==-Ge?null:Y.max,F);Y.min=ct[0],Y.max=ct[1]}}}for(let F in S){let Y=S[F];if(Y.from!=null){let K=S[Y.from];if(K.min==null)Y.min=Y.max=null;else{let ct=Y.range(n,K.min,K.max,F);Y.min=ct[0],Y.max=ct[1]}}}let A={},N=!1;for(let F in S){let Y=S[F],K=v[F];if(K.min!=Y.min||K.max!=Y.max){K.min=Y.min,K.max=Y.max;let ct=K.distr;K._min=ct==3?Hs(K.min):ct==4?Nf(K.min,K.asinh):ct==100?K.fwd(K.min):K.min,K._max=ct==3?Hs(K.max):ct==4?Nf(K.max,K.asinh):ct==100?K.fwd(K.max):K.max,A[F]=N=!0}}if(N){y.forEach((F,Y)=>{s==2?Y>0&&A.y&&(F._paths=null):A[F.scale]&&(F._paths=null)});for(let F in A)yt=!0,Fn("setScale",F);mt&&ht.left>=0&&(nt=pt=!0)}for(let F in X)X[F]=null}function Vt(S){let A=Gf(fn-1,0,ln-1),N=Gf(pn+1,0,ln-1);for(;S[A]==null&&A>0;)A--;for(;S[N]==null&&N<ln-1;)N++;return[A,N]}function xe(){if(ln>0){let S=y.some(A=>A._focus)&&Dt!=zt.alpha;S&&(h.globalAlpha=Dt=zt.alpha),y.forEach((A,N)=>{if(N>0&&A.show&&(sn(N,!1),sn(N,!0),A._paths==null)){let F=Dt;Dt!=A.alpha&&(h.globalAlpha=Dt=A.alpha);let Y=s==2?[0,t[N][0].length-1]:Vt(t[N]);A._paths=A.paths(n,N,Y[0],Y[1]),Dt!=F&&(h.globalAlpha=Dt=F)}}),y.forEach((A,N)=>{if(N>0&&A.show){let F=Dt;Dt!=A.alpha&&(h.globalAlpha=Dt=A.alpha),A._paths!=null&&Oe(N,!1);{let Y=A._paths!=null?A._paths.gaps:null,K=A.points.show(n,N,fn,pn,Y),ct=A.points.filter(n,N,K,Y);(K||ct)&&(A.points._paths=A.points.paths(n,N,fn,pn,ct),Oe(N,!0))}Dt!=F&&(h.globalAlpha=Dt=F),Fn("drawSeries",N)}}),S&&(h.globalAlpha=Dt=1)}}function sn(S,A){let N=A?y[S].points:y[S];N._stroke=N.stroke(n,S),N._fill=N.fill(n,S)}function Oe(S,A){let N=A?y[S].points:y[S],{stroke:F,fill:Y,clip:K,flags:ct,_stroke:ft=N._stroke,_fill:vt=N._fill,_width:Ot=N.width}=N._paths;Ot=He(Ot*Re,3);let Ut=null,kt=Ot%2/2;A&&vt==null&&(vt=Ot>0?"#fff":ft);let ae=N.pxAlign==1&&kt>0;if(ae&&h.translate(kt,kt),!A){let Ce=I-Ot/2,be=E-Ot/2,ye=$+Ot,Qt=dt+Ot;Ut=new Path2D,Ut.rect(Ce,be,ye,Qt)}A?Ft(ft,Ot,N.dash,N.cap,vt,F,Y,ct,K):Ue(S,ft,Ot,N.dash,N.cap,vt,F,Y,ct,Ut,K),ae&&h.translate(-kt,-kt)}function Ue(S,A,N,F,Y,K,ct,ft,vt,Ot,Ut){let kt=!1;vt!=0&&M.forEach((ae,Ce)=>{if(ae.series[0]==S){let be=y[ae.series[1]],ye=t[ae.series[1]],Qt=(be._paths||Cl).band;gr(Qt)&&(Qt=ae.dir==1?Qt[0]:Qt[1]);let Zt,Je=null;be.show&&Qt&&KT(ye,fn,pn)?(Je=ae.fill(n,Ce)||K,Zt=be._paths.clip):Qt=null,Ft(A,N,F,Y,Je,ct,ft,vt,Ot,Ut,Zt,Qt),kt=!0}}),kt||Ft(A,N,F,Y,K,ct,ft,vt,Ot,Ut)}let Tn=sa|Xf;function Ft(S,A,N,F,Y,K,ct,ft,vt,Ot,Ut,kt){At(S,A,N,F,Y),(vt||Ot||kt)&&(h.save(),vt&&h.clip(vt),Ot&&h.clip(Ot)),kt?(ft&Tn)==Tn?(h.clip(kt),Ut&&h.clip(Ut),ve(Y,ct),_n(S,K,A)):ft&Xf?(ve(Y,ct),h.clip(kt),_n(S,K,A)):ft&sa&&(h.save(),h.clip(kt),Ut&&h.clip(Ut),ve(Y,ct),h.restore(),_n(S,K,A)):(ve(Y,ct),_n(S,K,A)),(vt||Ot||kt)&&h.restore()}function _n(S,A,N){N>0&&(A instanceof Map?A.forEach((F,Y)=>{h.strokeStyle=Zr=Y,h.stroke(F)}):A!=null&&S&&h.stroke(A))}function ve(S,A){A instanceof Map?A.forEach((N,F)=>{h.fillStyle=Ys=F,h.fill(N)}):A!=null&&S&&h.fill(A)}function ws(S,A,N,F){let Y=T[S],K;if(F<=0)K=[0,0];else{let ct=Y._space=Y.space(n,S,A,N,F),ft=Y._incrs=Y.incrs(n,S,A,N,F,ct);K=yE(A,N,ft,F,ct)}return Y._found=K}function xn(S,A,N,F,Y,K,ct,ft,vt,Ot){let Ut=ct%2/2;_==1&&h.translate(Ut,Ut),At(ft,ct,vt,Ot,ft),h.beginPath();let kt,ae,Ce,be,ye=Y+(F==0||F==3?-K:K);N==0?(ae=Y,be=ye):(kt=Y,Ce=ye);for(let Qt=0;Qt<S.length;Qt++)A[Qt]!=null&&(N==0?kt=Ce=S[Qt]:ae=be=S[Qt],h.moveTo(kt,ae),h.lineTo(Ce,be));h.stroke(),_==1&&h.translate(-Ut,-Ut)}function jr(S){let A=!0;return T.forEach((N,F)=>{if(!N.show)return;let Y=v[N.scale];if(Y.min==null){N._show&&(A=!1,N._show=!1,fe(!1));return}else N._show||(A=!1,N._show=!0,fe(!1));let K=N.side,ct=K%2,{min:ft,max:vt}=Y,[Ot,Ut]=ws(F,ft,vt,ct==0?V:Pt);if(Ut==0)return;let kt=Y.distr==2,ae=N._splits=N.splits(n,F,ft,vt,Ot,Ut,kt),Ce=Y.distr==2?ae.map(Zt=>vi[Zt]):ae,be=Y.distr==2?vi[ae[1]]-vi[ae[0]]:Ot,ye=N._values=N.values(n,N.filter(n,Ce,F,Ut,be),F,Ut,be);N._rotate=K==2?N.rotate(n,ye,F,Ut):0;let Qt=N._size;N._size=Vi(N.size(n,ye,F,S)),Qt!=null&&N._size!=Qt&&(A=!1)}),A}function ss(S){let A=!0;return ha.forEach((N,F)=>{let Y=N(n,F,ns,S);Y!=Gi[F]&&(A=!1),Gi[F]=Y}),A}function bs(){for(let S=0;S<T.length;S++){let A=T[S];if(!A.show||!A._show)continue;let N=A.side,F=N%2,Y,K,ct=A.stroke(n,S),ft=N==0||N==3?-1:1,[vt,Ot]=A._found;if(A.label!=null){let oi=A.labelGap*ft,wi=In((A._lpos+oi)*Re);Nt(A.labelFont[0],ct,"center",N==2?"top":V0),h.save(),F==1?(Y=K=0,h.translate(wi,In(E+dt/2)),h.rotate((N==3?-uu:uu)/2)):(Y=In(I+$/2),K=wi);let Sr=P_(A.label)?A.label(n,S,vt,Ot):A.label;h.fillText(Sr,Y,K),h.restore()}if(Ot==0)continue;let Ut=v[A.scale],kt=F==0?$:dt,ae=F==0?I:E,Ce=A._splits,be=Ut.distr==2?Ce.map(oi=>vi[oi]):Ce,ye=Ut.distr==2?vi[Ce[1]]-vi[Ce[0]]:vt,Qt=A.ticks,Zt=A.border,Je=Qt.show?Qt.size:0,hn=In(Je*Re),Bn=In((A.alignTo==2?A._size-Je-A.gap:A.gap)*Re),ke=A._rotate*-uu/180,un=m(A._pos*Re),Si=(hn+Bn)*ft,ri=un+Si;K=F==0?ri:0,Y=F==1?ri:0;let Li=A.font[0],Hi=A.align==1?Ko:A.align==2?If:ke>0?Ko:ke<0?If:F==0?"center":N==3?If:Ko,as=ke||F==1?"middle":N==2?"top":V0;Nt(Li,ct,Hi,as);let Mi=A.font[1]*A.lineGap,Di=Ce.map(oi=>m(a(oi,Ut,kt,ae))),Wi=A._values;for(let oi=0;oi<Wi.length;oi++){let wi=Wi[oi];if(wi!=null){F==0?Y=Di[oi]:K=Di[oi],wi=""+wi;let Sr=wi.indexOf(`
`)==-1?[wi]:wi.split(/\n/gm);for(let ai=0;ai<Sr.length;ai++){let qp=Sr[ai];ke?(h.save(),h.translate(Y,K+ai*Mi),h.rotate(ke),h.fillText(qp,0,0),h.restore()):h.fillText(qp,Y,K+ai*Mi)}}}Qt.show&&xn(Di,Qt.filter(n,be,S,Ot,ye),F,N,un,hn,He(Qt.width*Re,3),Qt.stroke(n,S),Qt.dash,Qt.cap);let ls=A.grid;ls.show&&xn(Di,ls.filter(n,be,S,Ot,ye),F,F==0?2:1,F==0?E:I,F==0?dt:$,He(ls.width*Re,3),ls.stroke(n,S),ls.dash,ls.cap),Zt.show&&xn([un],[1],F==0?1:0,F==0?1:2,F==1?E:I,F==1?dt:$,He(Zt.width*Re,3),Zt.stroke(n,S),Zt.dash,Zt.cap)}Fn("drawAxes")}function fe(S){y.forEach((A,N)=>{N>0&&(A._paths=null,S&&(s==1?(A.min=null,A.max=null):A.facets.forEach(F=>{F.min=null,F.max=null})))})}let cn=!1,si=!1,Fe=[];function yn(){si=!1;for(let S=0;S<Fe.length;S++)Fn(...Fe[S]);Fe.length=0}function Jn(){cn||(d1(Rp),cn=!0)}function Ul(S,A=!1){cn=!0,si=A,S(n),Rp(),A&&Fe.length>0&&queueMicrotask(yn)}n.batch=Ul;function Rp(){if(ot&&(_e(),ot=!1),yt&&(Tt(),yt=!1),_t){if(Ke(f,Ko,Kt),Ke(f,"top",ce),Ke(f,bl,V),Ke(f,Tl,Pt),Ke(p,Ko,Kt),Ke(p,"top",ce),Ke(p,bl,V),Ke(p,Tl,Pt),Ke(u,bl,an),Ke(u,Tl,gn),d.width=In(an*Re),d.height=In(gn*Re),T.forEach(({_el:S,_show:A,_size:N,_pos:F,side:Y})=>{if(S!=null)if(A){let K=Y===3||Y===0?N:0,ct=Y%2==1;Ke(S,ct?"left":"top",F-K),Ke(S,ct?"width":"height",N),Ke(S,ct?"top":"left",ct?ce:Kt),Ke(S,ct?"height":"width",ct?Pt:V),zf(S,Gr)}else Ri(S,Gr)}),Zr=Ys=Jr=H=tt=J=j=Et=C=null,Dt=1,ma(!0),Kt!=bt||ce!=Ve||V!=Ht||Pt!=Jt){fe(!1);let S=V/Ht,A=Pt/Jt;if(mt&&!nt&&ht.left>=0){ht.left*=S,ht.top*=A,Kr&&ys(Kr,In(ht.left),0,V,Pt),Qr&&ys(Qr,0,In(ht.top),V,Pt);for(let N=0;N<ue.length;N++){let F=ue[N];F!=null&&(qe[N]*=S,ii[N]*=A,ys(F,Vi(qe[N]),Vi(ii[N]),V,Pt))}}if(Ze.show&&!st&&Ze.left>=0&&Ze.width>0){Ze.left*=S,Ze.width*=S,Ze.top*=A,Ze.height*=A;for(let N in Wu)Ke(no,N,Ze[N])}bt=Kt,Ve=ce,Ht=V,Jt=Pt}Fn("setSize"),_t=!1}an>0&&gn>0&&(h.clearRect(0,0,d.width,d.height),Fn("drawClear"),w.forEach(S=>S()),Fn("draw")),Ze.show&&st&&(Fl(Ze),st=!1),mt&&nt&&(vr(null,!0,!1),nt=!1),lt.show&&lt.live&&pt&&(Gu(),pt=!1),l||(l=!0,n.status=1,Fn("ready")),Xs=!1,cn=!1}n.redraw=(S,A)=>{yt=A||!1,S!==!1?$s(b,L.min,L.max):Jn()};function ku(S,A){let N=v[S];if(N.from==null){if(ln==0){let F=N.range(n,A.min,A.max,S);A.min=F[0],A.max=F[1]}if(A.min>A.max){let F=A.min;A.min=A.max,A.max=F}if(ln>1&&A.min!=null&&A.max!=null&&A.max-A.min<1e-16)return;S==b&&N.distr==2&&ln>0&&(A.min=ts(A.min,t[0]),A.max=ts(A.max,t[0]),A.min==A.max&&A.max++),X[S]=A,ot=!0,Jn()}}n.setScale=ku;let zu,Vu,Kr,Qr,Pp,Ip,to,eo,Lp,Dp,$e,tn,qs=!1,Hn=ht.drag,On=Hn.x,Un=Hn.y;mt&&(ht.x&&(zu=zi(UT,p)),ht.y&&(Vu=zi(FT,p)),L.ori==0?(Kr=zu,Qr=Vu):(Kr=Vu,Qr=zu),$e=ht.left,tn=ht.top);let Ze=n.select=wn({show:!0,over:!0,left:0,width:0,top:0,height:0},i.select),no=Ze.show?zi(OT,Ze.over?p:f):null;function Fl(S,A){if(Ze.show){for(let N in S)Ze[N]=S[N],N in Wu&&Ke(no,N,S[N]);A!==!1&&Fn("setSelect")}}n.setSelect=Fl;function Xx(S){if(y[S].show)et&&zf(le[S],Gr);else if(et&&Ri(le[S],Gr),mt){let N=Rt?ue[0]:ue[S];N!=null&&ys(N,-10,-10,V,Pt)}}function $s(S,A,N){ku(S,{min:A,max:N})}function rs(S,A,N,F){A.focus!=null&&Jx(S),A.show!=null&&y.forEach((Y,K)=>{K>0&&(S==K||S==null)&&(Y.show=A.show,Xx(K),s==2?($s(Y.facets[0].scale,null,null),$s(Y.facets[1].scale,null,null)):$s(Y.scale,null,null),Jn())}),N!==!1&&Fn("setSeries",S,A),F&&ga("setSeries",n,S,A)}n.setSeries=rs;function Yx(S,A){wn(M[S],A)}function qx(S,A){S.fill=Me(S.fill||null),S.dir=Ae(S.dir,-1),A=A??M.length,M.splice(A,0,S)}function $x(S){S==null?M.length=0:M.splice(S,1)}n.addBand=qx,n.setBand=Yx,n.delBand=$x;function Zx(S,A){y[S].alpha=A,mt&&ue[S]!=null&&(ue[S].style.opacity=A),et&&le[S]&&(le[S].style.opacity=A)}let Ts,Zs,yr,io={focus:!0};function Jx(S){if(S!=yr){let A=S==null,N=zt.alpha!=1;y.forEach((F,Y)=>{if(s==1||Y>0){let K=A||Y==0||Y==S;F._focus=A?null:K,N&&Zx(Y,K?1:zt.alpha)}}),yr=S,N&&Jn()}}et&&ne&&we(X0,Ct,S=>{ht._lock||(ee(S),yr!=null&&rs(null,io,!0,vn.setSeries))});function os(S,A,N){let F=v[A];N&&(S=S/Re-(F.ori==1?ce:Kt));let Y=V;F.ori==1&&(Y=Pt,S=Y-S),F.dir==-1&&(S=Y-S);let K=F._min,ct=F._max,ft=S/Y,vt=K+(ct-K)*ft,Ot=F.distr;return Ot==3?ea(10,vt):Ot==4?t1(vt,F.asinh):Ot==100?F.bwd(vt):vt}function jx(S,A){let N=os(S,b,A);return ts(N,t[0],fn,pn)}n.valToIdx=S=>ts(S,t[0]),n.posToIdx=jx,n.posToVal=os,n.valToPos=(S,A,N)=>v[A].ori==0?r(S,v[A],N?$:V,N?I:0):o(S,v[A],N?dt:Pt,N?E:0),n.setCursor=(S,A,N)=>{$e=S.left,tn=S.top,vr(null,A,N)};function Np(S,A){Ke(no,Ko,Ze.left=S),Ke(no,bl,Ze.width=A)}function Op(S,A){Ke(no,"top",Ze.top=S),Ke(no,Tl,Ze.height=A)}let fa=L.ori==0?Np:Op,pa=L.ori==1?Np:Op;function Kx(){if(et&&lt.live)for(let S=s==2?1:0;S<y.length;S++){if(S==0&&de)continue;let A=lt.values[S],N=0;for(let F in A)Yt[S][N++].firstChild.nodeValue=A[F]}}function Gu(S,A){if(S!=null&&(S.idxs?S.idxs.forEach((N,F)=>{Q[F]=N}):s1(S.idx)||Q.fill(S.idx),lt.idx=Q[0]),et&&lt.live){for(let N=0;N<y.length;N++)(N>0||s==1&&!de)&&Qx(N,Q[N]);Kx()}pt=!1,A!==!1&&Fn("setLegend")}n.setLegend=Gu;function Qx(S,A){let N=y[S],F=S==0&&B==2?vi:t[S],Y;de?Y=N.values(n,S,A)??oe:(Y=N.value(n,A==null?null:F[A],S,A),Y=Y==null?oe:{_:Y}),lt.values[S]=Y}function vr(S,A,N){Lp=$e,Dp=tn,[$e,tn]=ht.move(n,$e,tn),ht.left=$e,ht.top=tn,mt&&(Kr&&ys(Kr,In($e),0,V,Pt),Qr&&ys(Qr,0,In(tn),V,Pt));let F,Y=fn>pn;Ts=Ge,Zs=null;let K=L.ori==0?V:Pt,ct=L.ori==1?V:Pt;if($e<0||ln==0||Y){F=ht.idx=null;for(let ft=0;ft<y.length;ft++){let vt=ue[ft];vt!=null&&ys(vt,-10,-10,V,Pt)}ne&&rs(null,io,!0,S==null&&vn.setSeries),lt.live&&(Q.fill(F),pt=!0)}else{let ft,vt,Ot;s==1&&(ft=L.ori==0?$e:tn,vt=os(ft,b),F=ht.idx=ts(vt,t[0],fn,pn),Ot=G(t[0][F],L,K,0));let Ut=-10,kt=-10,ae=0,Ce=0,be=!0,ye="",Qt="";for(let Zt=s==2?1:0;Zt<y.length;Zt++){let Je=y[Zt],hn=Q[Zt],Bn=hn==null?null:s==1?t[Zt][hn]:t[Zt][1][hn],ke=ht.dataIdx(n,Zt,F,vt),un=ke==null?null:s==1?t[Zt][ke]:t[Zt][1][ke];if(pt=pt||un!=Bn||ke!=hn,Q[Zt]=ke,Zt>0&&Je.show){let Si=ke==null?-10:ke==F?Ot:G(s==1?t[0][ke]:t[Zt][0][ke],L,K,0),ri=un==null?-10:D(un,s==1?v[Je.scale]:v[Je.facets[1].scale],ct,0);if(ne&&un!=null){let Li=L.ori==1?$e:tn,Hi=Ln(zt.dist(n,Zt,ke,ri,Li));if(Hi<Ts){let as=zt.bias;if(as!=0){let Mi=os(Li,Je.scale),Di=un>=0?1:-1,Wi=Mi>=0?1:-1;Wi==Di&&(Wi==1?as==1?un>=Mi:un<=Mi:as==1?un<=Mi:un>=Mi)&&(Ts=Hi,Zs=Zt)}else Ts=Hi,Zs=Zt}}if(pt||Rt){let Li,Hi;L.ori==0?(Li=Si,Hi=ri):(Li=ri,Hi=Si);let as,Mi,Di,Wi,ls,oi,wi=!0,Sr=ut.bbox;if(Sr!=null){wi=!1;let ai=Sr(n,Zt);Di=ai.left,Wi=ai.top,as=ai.width,Mi=ai.height}else Di=Li,Wi=Hi,as=Mi=ut.size(n,Zt);if(oi=ut.fill(n,Zt),ls=ut.stroke(n,Zt),Rt)Zt==Zs&&Ts<=zt.prox&&(Ut=Di,kt=Wi,ae=as,Ce=Mi,be=wi,ye=oi,Qt=ls);else{let ai=ue[Zt];ai!=null&&(qe[Zt]=Di,ii[Zt]=Wi,K0(ai,as,Mi,wi),J0(ai,oi,ls),ys(ai,Vi(Di),Vi(Wi),V,Pt))}}}}if(Rt){let Zt=zt.prox,Je=yr==null?Ts<=Zt:Ts>Zt||Zs!=yr;if(pt||Je){let hn=ue[0];hn!=null&&(qe[0]=Ut,ii[0]=kt,K0(hn,ae,Ce,be),J0(hn,ye,Qt),ys(hn,Vi(Ut),Vi(kt),V,Pt))}}}if(Ze.show&&qs)if(S!=null){let[ft,vt]=vn.scales,[Ot,Ut]=vn.match,[kt,ae]=S.cursor.sync.scales,Ce=S.cursor.drag;if(On=Ce._x,Un=Ce._y,On||Un){let{left:be,top:ye,width:Qt,height:Zt}=S.select,Je=S.scales[kt].ori,hn=S.posToVal,Bn,ke,un,Si,ri,Li=ft!=null&&Ot(ft,kt),Hi=vt!=null&&Ut(vt,ae);Li&&On?(Je==0?(Bn=be,ke=Qt):(Bn=ye,ke=Zt),un=v[ft],Si=G(hn(Bn,kt),un,K,0),ri=G(hn(Bn+ke,kt),un,K,0),fa(es(Si,ri),Ln(ri-Si))):fa(0,K),Hi&&Un?(Je==1?(Bn=be,ke=Qt):(Bn=ye,ke=Zt),un=v[vt],Si=D(hn(Bn,ae),un,ct,0),ri=D(hn(Bn+ke,ae),un,ct,0),pa(es(Si,ri),Ln(ri-Si))):pa(0,ct)}else Xu()}else{let ft=Ln(Lp-Pp),vt=Ln(Dp-Ip);if(L.ori==1){let ae=ft;ft=vt,vt=ae}On=Hn.x&&ft>=Hn.dist,Un=Hn.y&&vt>=Hn.dist;let Ot=Hn.uni;Ot!=null?On&&Un&&(On=ft>=Ot,Un=vt>=Ot,!On&&!Un&&(vt>ft?Un=!0:On=!0)):Hn.x&&Hn.y&&(On||Un)&&(On=Un=!0);let Ut,kt;On&&(L.ori==0?(Ut=to,kt=$e):(Ut=eo,kt=tn),fa(es(Ut,kt),Ln(kt-Ut)),Un||pa(0,ct)),Un&&(L.ori==1?(Ut=to,kt=$e):(Ut=eo,kt=tn),pa(es(Ut,kt),Ln(kt-Ut)),On||fa(0,K)),!On&&!Un&&(fa(0,0),pa(0,0))}if(Hn._x=On,Hn._y=Un,S==null){if(N){if(Yp!=null){let[ft,vt]=vn.scales;vn.values[0]=ft!=null?os(L.ori==0?$e:tn,ft):null,vn.values[1]=vt!=null?os(L.ori==1?$e:tn,vt):null}ga(Lf,n,$e,tn,V,Pt,F)}if(ne){let ft=N&&vn.setSeries,vt=zt.prox;yr==null?Ts<=vt&&rs(Zs,io,!0,ft):Ts>vt?rs(null,io,!0,ft):Zs!=yr&&rs(Zs,io,!0,ft)}}pt&&(lt.idx=F,Gu()),A!==!1&&Fn("setCursor")}let Js=null;Object.defineProperty(n,"rect",{get(){return Js==null&&ma(!1),Js}});function ma(S=!1){S?Js=null:(Js=p.getBoundingClientRect(),Fn("syncRect",Js))}function Up(S,A,N,F,Y,K,ct){ht._lock||qs&&S!=null&&S.movementX==0&&S.movementY==0||(Hu(S,A,N,F,Y,K,ct,!1,S!=null),S!=null?vr(null,!0,!0):vr(A,!0,!1))}function Hu(S,A,N,F,Y,K,ct,ft,vt){if(Js==null&&ma(!1),ee(S),S!=null)N=S.clientX-Js.left,F=S.clientY-Js.top;else{if(N<0||F<0){$e=-10,tn=-10;return}let[Ot,Ut]=vn.scales,kt=A.cursor.sync,[ae,Ce]=kt.values,[be,ye]=kt.scales,[Qt,Zt]=vn.match,Je=A.axes[0].side%2==1,hn=L.ori==0?V:Pt,Bn=L.ori==1?V:Pt,ke=Je?K:Y,un=Je?Y:K,Si=Je?F:N,ri=Je?N:F;if(be!=null?N=Qt(Ot,be)?a(ae,v[Ot],hn,0):-10:N=hn*(Si/ke),ye!=null?F=Zt(Ut,ye)?a(Ce,v[Ut],Bn,0):-10:F=Bn*(ri/un),L.ori==1){let Li=N;N=F,F=Li}}vt&&(A==null||A.cursor.event.type==Lf)&&((N<=1||N>=V-1)&&(N=zr(N,V)),(F<=1||F>=Pt-1)&&(F=zr(F,Pt))),ft?(Pp=N,Ip=F,[to,eo]=ht.move(n,N,F)):($e=N,tn=F)}let Wu={width:0,height:0,left:0,top:0};function Xu(){Fl(Wu,!1)}let Fp,Bp,kp,zp;function Vp(S,A,N,F,Y,K,ct){qs=!0,On=Un=Hn._x=Hn._y=!1,Hu(S,A,N,F,Y,K,ct,!0,!1),S!=null&&(we(Df,Bf,Gp,!1),ga(H0,n,to,eo,V,Pt,null));let{left:ft,top:vt,width:Ot,height:Ut}=Ze;Fp=ft,Bp=vt,kp=Ot,zp=Ut}function Gp(S,A,N,F,Y,K,ct){qs=Hn._x=Hn._y=!1,Hu(S,A,N,F,Y,K,ct,!1,!0);let{left:ft,top:vt,width:Ot,height:Ut}=Ze,kt=Ot>0||Ut>0,ae=Fp!=ft||Bp!=vt||kp!=Ot||zp!=Ut;if(kt&&ae&&Fl(Ze),Hn.setScale&&kt&&ae){let Ce=ft,be=Ot,ye=vt,Qt=Ut;if(L.ori==1&&(Ce=vt,be=Ut,ye=ft,Qt=Ot),On&&$s(b,os(Ce,b),os(Ce+be,b)),Un)for(let Zt in v){let Je=v[Zt];Zt!=b&&Je.from==null&&Je.min!=Ge&&$s(Zt,os(ye+Qt,Zt),os(ye,Zt))}Xu()}else ht.lock&&(ht._lock=!ht._lock,vr(A,!0,S!=null));S!=null&&(bn(Df,Bf),ga(Df,n,$e,tn,V,Pt,null))}function ty(S,A,N,F,Y,K,ct){if(ht._lock)return;ee(S);let ft=qs;if(qs){let vt=!0,Ot=!0,Ut=10,kt,ae;L.ori==0?(kt=On,ae=Un):(kt=Un,ae=On),kt&&ae&&(vt=$e<=Ut||$e>=V-Ut,Ot=tn<=Ut||tn>=Pt-Ut),kt&&vt&&($e=$e<to?0:V),ae&&Ot&&(tn=tn<eo?0:Pt),vr(null,!0,!0),qs=!1}$e=-10,tn=-10,Q.fill(null),vr(null,!0,!0),ft&&(qs=ft)}function Hp(S,A,N,F,Y,K,ct){ht._lock||(ee(S),da(),Xu(),S!=null&&ga(Y0,n,$e,tn,V,Pt,null))}function Wp(){T.forEach(vE),z(n.width,n.height,!0)}Hr(du,ta,Wp);let so={};so.mousedown=Vp,so.mousemove=Up,so.mouseup=Gp,so.dblclick=Hp,so.setSeries=(S,A,N,F)=>{let Y=vn.match[2];N=Y(n,A,N),N!=-1&&rs(N,F,!0,!1)},mt&&(we(H0,p,Vp),we(Lf,p,Up),we(W0,p,S=>{ee(S),ma(!1)}),we(X0,p,ty),we(Y0,p,Hp),Yf.add(n),n.syncRect=ma);let Bl=n.hooks=i.hooks||{};function Fn(S,A,N){si?Fe.push([S,A,N]):S in Bl&&Bl[S].forEach(F=>{F.call(null,n,A,N)})}(i.plugins||[]).forEach(S=>{for(let A in S.hooks)Bl[A]=(Bl[A]||[]).concat(S.hooks[A])});let Xp=(S,A,N)=>N,vn=wn({key:null,setSeries:!1,filters:{pub:i_,sub:i_},scales:[b,y[1]?y[1].scale:null],match:[s_,s_,Xp],values:[null,null]},ht.sync);vn.match.length==2&&vn.match.push(Xp),ht.sync=vn;let Yp=vn.key,Yu=tx(Yp);function ga(S,A,N,F,Y,K,ct){vn.filters.pub(S,A,N,F,Y,K,ct)&&Yu.pub(S,A,N,F,Y,K,ct)}Yu.sub(n);function ey(S,A,N,F,Y,K,ct){vn.filters.sub(S,A,N,F,Y,K,ct)&&so[S](null,A,N,F,Y,K,ct)}n.pub=ey;function ny(){Yu.unsub(n),Yf.delete(n),Nn.clear(),Vf(du,ta,Wp),c.remove(),Ct?.remove(),Fn("destroy")}n.destroy=ny;function qu(){Fn("init",i,t),ua(t||i.data,!1),X[b]?ku(b,X[b]):da(),st=Ze.show&&(Ze.width>0||Ze.height>0),nt=pt=!0,z(i.width,i.height)}return y.forEach($r),T.forEach(Ss),e?e instanceof HTMLElement?(e.appendChild(c),qu()):e(n,qu):qu(),n}Gn.assign=wn;Gn.fmtNum=Qf;Gn.rangeNum=fu;Gn.rangeLog=gu;Gn.rangeAsinh=jf;Gn.orient=Xr;Gn.pxRatio=Re;Gn.join=u1;Gn.fmtDate=ep,Gn.tzDate=M1;Gn.sync=tx;{Gn.addGap=sE,Gn.clipGaps=yu;let i=Gn.paths={points:ox};i.linear=lx,i.stepped=aE,i.bars=lE,i.spline=hE}var lp="text/plain",wu=class{constructor(t,e,n){Object.assign(this,{app:t,store:e,choose:n}),this.topics=[],this.types={},this.rates={},this.models=[],this.truth=[],this.open=new Set,this.search=U("input",{id:"topic-search",type:"search",placeholder:"Find a topic or field",oninput:()=>this.show()}),this.path=U("input",{id:"topic-path",placeholder:"/topic.field, Enter",title:"For example /scan.ranges[180] or /odom.pose.pose.position",onkeydown:s=>{s.key==="Enter"&&this.add(this.path.value.trim())&&(this.path.value="")}}),this.list=U("div",{class:"topic-rows"}),this.element=U("div",{class:"topics"},this.search,this.path,this.list),t.on("packet:topics",s=>this.take(s)),t.on("packet:rates",({rates:s})=>{this.rates=s;for(let r of this.list.querySelectorAll("[data-rate]"))r.textContent=this.rateOf(r.dataset.rate)})}setShown(t){if(this.store.file){this.topics.length||this.take(this.store.file.get("topics")??{topics:[],types:{},models:[...this.app.bodyOf.keys()],truth:Object.keys(Af)});return}this.app.connection.want("topics",t?{}:null),this.app.scene?.recording||this.app.connection.want("rates",t?{}:null)}take({topics:t,types:e,models:n,truth:s}){if(Object.assign(this,{topics:t,types:e,models:n,truth:s}),this.store.file)for(let r of t)r.fields=[...new Set((this.store.file.get(r.name)?.curves??[]).map(o=>o.path))];this.rates=Object.fromEntries(t.filter(r=>r.rate).map(r=>[r.name,r.rate]).concat(Object.entries(this.rates))),this.show()}rateOf(t){let e=this.rates[t];return e===void 0?"":`${e>=100?e.toFixed(0):e>=10?e.toFixed(1):e.toFixed(2)} Hz`}fieldsOf(t){return t.fields??this.types[t.type]??[]}add(t){let e=this.topics.map(s=>s.name).filter(s=>t.startsWith(s)&&"./[".includes(t[s.length]??" ")).sort((s,r)=>r.length-s.length)[0],n=this.models.some(s=>t.startsWith(`${s}.`));return e?this.choose(e,t.slice(e.length).replace(/^[./]/,"")):n?this.choose(xs,t):this.app.report(`there is no topic with numbers for ${t}`),!!e||n}show(){let t=this.search.value.trim().toLowerCase(),e=[],n=(s,r)=>!t||s.toLowerCase().includes(t)||r.some(o=>`${s}.${o}`.toLowerCase().includes(t));for(let s of this.models){let r=this.truth.map(o=>`${s}.${o}`);n(`${s} (truth)`,r)&&e.push(this.row(`truth:${s}`,s,"true pose and velocity",null,()=>r.map(o=>[xs,o,o.slice(s.length+1)])))}for(let s of this.topics){let r=this.fieldsOf(s);r.length&&n(s.name,r)&&e.push(this.row(s.name,s.name,s.type,s.name,()=>r.filter(o=>!t||s.name.toLowerCase().includes(t)||o.toLowerCase().includes(t)).map(o=>[s.name,o,o])))}this.list.replaceChildren(...e.length?e:[U("p",{class:"dim"},this.topics.length?"nothing found":"no topics")])}row(t,e,n,s,r){let o=s===null?null:U("span",{class:"rate","data-rate":s},this.rateOf(s)),a=U("details",{"data-topic":t,open:this.open.has(t)},U("summary",{title:`${e}
${n}`},U("span",{class:"name"},e),o,U("span",{class:"type"},n.replace("/msg/","/")))),l=()=>{a.open&&a.childElementCount===1&&a.append(...r().map(([c,d,h])=>this.field(c,d,h)))};return a.addEventListener("toggle",()=>{a.open?this.open.add(t):this.open.delete(t),l()}),l(),a}field(t,e,n){let s=n.split("[]"),r=s.slice(1).map(()=>U("input",{class:"index",value:"0",size:3,title:"Index, name, or range such as 0:5"})),o=()=>e.split("[]").map((c,d)=>c+(d<r.length?`[${r[d].value.trim()||0}]`:"")).join(""),a=s.flatMap((c,d)=>d<r.length?[`${c}[`,r[d],"]"]:[c]),l=U("div",{class:"field",draggable:!0,tabIndex:0,role:"button",title:"Drag to a plot, or click","data-field":e},...a);return l.addEventListener("dragstart",c=>{c.dataTransfer.setData(lp,JSON.stringify([t,o()])),c.dataTransfer.effectAllowed="copy"}),l.addEventListener("click",c=>{c.target.tagName!=="INPUT"&&this.choose(t,o())}),l.addEventListener("keydown",c=>{c.key==="Enter"&&this.choose(t,o())}),l}};var cp=["#4c9ffe","#f2a33c","#3fbf7f","#e5636b","#b38cf4","#2fc4c9","#e87fbf","#a8b545","#8d99ae","#d98e5f"],SE=Array.from({length:49},(i,t)=>[1,2,5].map(e=>+`${e}e${t-24}`)).flat(),hp=[["5 s",5],["10 s",10],["30 s",30],["60 s",60],["5 min",300],["all",1/0]],bu=class{constructor(t,e,{close:n,select:s,changed:r}){Object.assign(this,{app:t,store:e,changed:r}),this.fields=[],this.zoom=null,this.isPaused=this.usesStamps=this.inDegrees=!1,this.shape="",this.colours=new Map;let o=(c,d,h,u)=>U("button",{class:c,title:h,"aria-label":h,onclick:u},d);this.pause=o("pause","\u275A\u275A","Pause or resume the drawing; data are kept",()=>this.setPaused(!this.isPaused)),this.range=U("select",{class:"range",title:"Shown time",onchange:()=>{this.zoom=null,this.draw()}},...hp.map(([c])=>U("option",{},c))),this.range.selectedIndex=t.scene?.recording?hp.length-1:2,this.axis=U("select",{class:"axis",title:"Time axis",onchange:()=>{this.usesStamps=this.axis.selectedIndex===1,this.zoom=null,this.draw()}},U("option",{},"receive time"),U("option",{},"header stamp")),this.degrees=o("degrees","\xB0","Show angles in degrees",()=>{this.inDegrees=!this.inDegrees,this.degrees.classList.toggle("on",this.inDegrees),this.draw()}),this.legend=U("div",{class:"legend"}),this.area=U("div",{class:"area"}),this.hint=U("p",{class:"hint dim"},"Drag fields here, or click them in the list");let a=o("clear","Clear","Drop the samples",()=>this.clear());a.hidden=!!t.scene?.recording;let l=U("div",{class:"plot-tools"},this.pause,this.range,this.axis,this.degrees,a,o("csv","CSV","Save the samples as CSV",()=>this.saveCsv()),o("png","PNG","Save the picture",()=>this.savePng()),o("close","\u2715","Close the plot",()=>n(this)));this.element=U("div",{class:"plot"},U("div",{class:"plot-head"},this.legend,l),this.area),this.area.append(this.hint),this.element.addEventListener("pointerdown",()=>s(this)),this.element.addEventListener("dragover",c=>{c.preventDefault(),this.element.classList.add("over")}),this.element.addEventListener("dragleave",()=>this.element.classList.remove("over")),this.element.addEventListener("drop",c=>{c.preventDefault(),this.element.classList.remove("over");try{this.add(...JSON.parse(c.dataTransfer.getData(lp)))}catch{}}),this.size=new ResizeObserver(()=>this.resize()),this.size.observe(this.area)}add(t,e){!e||this.fields.some(n=>n.topic===t&&n.field===e)||(this.fields.push({topic:t,field:e}),this.store.use(t,e,!0),this.changed(),this.draw())}remove(t,e){this.fields=this.fields.filter(n=>n.topic!==t||n.field!==e),this.store.use(t,e,!1),this.changed(),this.draw()}close(){for(let{topic:t,field:e}of[...this.fields])this.remove(t,e);this.size.disconnect(),this.chart?.destroy()}clear(){for(let{topic:t,field:e}of this.fields)this.store.clear(t,e);this.zoom=null,this.draw()}setPaused(t){this.isPaused=t,this.pause.textContent=t?"\u25B6":"\u275A\u275A",this.pause.classList.toggle("on",t),t||this.draw()}curves(){let t=this.fields.flatMap(({topic:e,field:n})=>this.store.of(e,n));return[...new Map(t.map(e=>[e.key,e])).values()]}colourOf(t){if(!this.colours.has(t.key)){let e=new Set(this.curves().map(n=>this.colours.get(n.key)));this.colours.set(t.key,cp.find(n=>!e.has(n))??cp[this.colours.size%cp.length])}return this.colours.get(t.key)}scale(t){return this.inDegrees&&t.unit==="rad"?180/Math.PI:1}unit(t){return this.inDegrees&&t.unit==="rad"?"\xB0":t.unit}times(t){return this.usesStamps&&t.s.some(Number.isFinite)?t.s:t.t}limits(t){if(this.zoom)return this.zoom;let e=t.map(r=>this.times(r)).filter(r=>r.length);if(!e.length)return[0,1];let n=Math.max(...e.map(r=>r[r.length-1])),s=Math.min(...e.map(r=>r[0]));return[Math.max(s,n-hp[this.range.selectedIndex][1]),Math.max(n,s+.1)]}draw(){if(this.isPaused&&this.chart){this.showLegend();return}let t=this.curves();if(this.hint.hidden=this.fields.length>0,this.make(t),this.showLegend(),!this.chart)return;let[e,n]=this.limits(t);this.chart.batch(()=>{this.chart.setData(this.table(t,e,n),!1),this.chart.setScale("x",{min:e,max:n})})}table(t,e,n){if(!t.length)return[[]];let s=t.map(r=>{let o=this.times(r),a=Math.max(0,up(o,e)-1),l=Math.min(o.length,up(o,n)+1),c=this.scale(r),d=[],h=[];for(let u=a;u<l;u++)!Number.isFinite(o[u])||d.length&&o[u]<=d[d.length-1]||(d.push(o[u]),h.push(Number.isFinite(r.v[u])?r.v[u]*c:null));return[d,h]});return s.length===1?s[0]:Gn.join(s)}make(t){let e=JSON.stringify([t.map(p=>[p.key,this.unit(p)]),matchMedia("(prefers-color-scheme: light)").matches]);if(e===this.shape||(this.shape=e,this.chart?.destroy(),this.chart=null,!t.length))return;let n=getComputedStyle(document.body),s=n.getPropertyValue("--dim").trim(),r=n.getPropertyValue("--grid").trim(),o="11px system-ui, sans-serif",a=[...new Set(t.map(p=>this.unit(p)))],l=a.slice(0,2),c=p=>l.includes(this.unit(p))?`u${l.indexOf(this.unit(p))}`:`u${l.length-1}`,d=p=>({stroke:s,font:o,labelFont:o,labelSize:16,grid:{stroke:r,width:1},ticks:{stroke:r,width:1,size:4},gap:3,incrs:SE,values:bE,...p}),h={x:{time:!1},...Object.fromEntries(l.map((p,_)=>[`u${_}`,{range:(m,g,y)=>ME(g,y)}]))},{width:u,height:f}=this.space();this.chart=new Gn({width:u,height:f,scales:h,legend:{show:!1},padding:[8,l.length>1?0:12,0,0],cursor:{drag:{x:!0,y:!1,setScale:!1},points:{size:5},focus:{prox:24}},focus:{alpha:.4},series:[{},...t.map(p=>({label:p.label,stroke:this.colourOf(p),width:1.5,scale:c(p),points:{show:!1},spanGaps:!1,pxAlign:0,paths:p.isAngle?wE(c(p),Math.PI*this.scale(p)):void 0}))],axes:[d({size:24}),...l.map((p,_)=>d({scale:`u${_}`,side:_?1:3,size:52,label:(_?a.slice(1):[p]).filter(Boolean).join(", ")||" ",grid:{show:_===0,stroke:r,width:1}}))],hooks:{setSelect:[p=>this.setZoom(p)],setCursor:[()=>this.showValues()],draw:[p=>this.drawNow(p)],ready:[p=>p.over.addEventListener("dblclick",()=>{this.zoom=null,this.draw()})]}},[[],...t.map(()=>[])],this.area)}setZoom(t){let{left:e,width:n}=t.select;n<4||(this.zoom=[t.posToVal(e,"x"),t.posToVal(e+n,"x")],t.setSelect({left:0,top:0,width:0,height:0},!1),this.isPaused?t.setScale("x",{min:this.zoom[0],max:this.zoom[1]}):this.draw())}drawNow(t){if(!this.app.player||!this.app.state)return;let e=t.valToPos(this.app.state.time,"x",!0),{left:n,top:s,width:r,height:o}=t.bbox;e<n||e>n+r||(t.ctx.fillStyle="#f2a33c",t.ctx.fillRect(Math.round(e),s,Math.max(1,devicePixelRatio),o))}showLegend(){this.legendOf?.join()===this.legendKey()||(this.legendOf=[this.legendKey()],this.legend.replaceChildren(...this.fields.flatMap(({topic:e,field:n})=>{let s=()=>U("button",{class:"drop",title:"Remove","aria-label":`Remove ${n}`,onclick:()=>this.remove(e,n)},"\u2715"),r=this.store.of(e,n),o=this.store.errors.get(`${e} ${n}`);return r.length?r.map((a,l)=>{let c=U("i",{}),d=U("output",{});return c.style.background=this.colourOf(a),U("span",{class:"key",title:a.label,"data-curve":a.key},c,U("span",{class:"label"},U("bdi",{},a.label)),d,l?null:s())}):[U("span",{class:`key ${o?"wrong":""}`,title:o??""},o?`${n}: ${o}`:`${e}.${n} \u2026`,s())]}))),this.showValues()}legendKey(){return JSON.stringify(this.fields.map(({topic:t,field:e})=>[t,e,this.store.of(t,e).map(n=>n.key),this.store.errors.get(`${t} ${e}`)]))}showValues(){let t=this.chart?.cursor.left>=0?this.chart.posToVal(this.chart.cursor.left,"x"):null;for(let e of this.legend.querySelectorAll("[data-curve]")){let n=this.store.curves.get(e.dataset.curve);if(!n?.v.length){e.querySelector("output").textContent="";continue}let s=t??(this.app.player?this.app.state?.time??0:1/0),r=Math.max(0,up(this.times(n),s)-1),o=n.v[Math.min(r,n.v.length-1)];e.querySelector("output").textContent=`${TE(o*this.scale(n))}${this.unit(n)?` ${this.unit(n)}`:""}`}}space(){return{width:Math.max(120,this.area.clientWidth),height:Math.max(80,this.area.clientHeight)}}resize(){this.chart&&this.area.clientWidth&&this.chart.setSize(this.space())}csv(){let t=this.curves(),e=new Map;t.forEach((o,a)=>this.times(o).forEach((l,c)=>{e.has(l)||e.set(l,new Array(t.length).fill("")),e.get(l)[a]=Number.isFinite(o.v[c])?o.v[c]:"nan"}));let n=o=>/[",\n]/.test(o)?`"${o.replaceAll('"','""')}"`:o,s=["time [s]",...t.map(o=>n(o.label+(o.unit?` [${o.unit}]`:"")))],r=[...e].sort((o,a)=>o[0]-a[0]).map(([o,a])=>[+o.toFixed(9),...a.map(l=>typeof l=="number"?+l.toPrecision(9):l)].join(","));return[s.join(","),...r,""].join(`
`)}saveCsv(){dx(new Blob([this.csv()],{type:"text/csv"}),"simkit-plot.csv")}picture(){let t=getComputedStyle(document.body),e=this.chart.ctx.canvas,n=e.width/this.chart.width,s=18*n,r=this.curves(),o=U("canvas",{width:e.width,height:e.height+s*r.length+8*n}),a=o.getContext("2d");return a.fillStyle=t.getPropertyValue("--panel"),a.fillRect(0,0,o.width,o.height),a.font=`${12*n}px system-ui, sans-serif`,r.forEach((l,c)=>{let d=(c+.8)*s;a.fillStyle=this.colourOf(l),a.fillRect(12*n,d-8*n,14*n,8*n),a.fillStyle=t.getPropertyValue("--text"),a.fillText(l.label+(this.unit(l)?` [${this.unit(l)}]`:""),32*n,d)}),a.drawImage(e,0,s*r.length+8*n),o}savePng(){this.chart&&this.picture().toBlob(t=>dx(t,"simkit-plot.png"),"image/png")}};function dx(i,t){let e=URL.createObjectURL(i),n=U("a",{href:e,download:t});document.body.append(n),n.click(),n.remove(),setTimeout(()=>URL.revokeObjectURL(e),1e4)}function up(i,t){let e=0,n=i.length;for(;e<n;){let s=e+n>>1;i[s]<=t?e=s+1:n=s}return e}function ME(i,t){if(i===null||t===null)return[-1,1];let e=t>i?.08*(t-i):Math.max(Math.abs(t)*.1,.1);return[i-e,t+e]}function wE(i,t){return(e,n,s,r)=>{let o=new Path2D,a=e.data[0],l=e.data[n],c=null;for(let d=s;d<=r;d++){let h=l[d];if(h===void 0)continue;if(h===null){c=null;continue}let u=e.valToPos(a[d],"x",!0),f=e.valToPos(h,i,!0);c===null||Math.abs(h-c)>t?o.moveTo(u,f):o.lineTo(u,f),c=h}return{stroke:o,fill:null,clip:null,flags:1}}}function bE(i,t,e,n,s){let r=Math.max(...t.map(Math.abs)),o=Math.max(0,-Math.floor(Math.log10(s)+1e-9));return o>5||r>=1e6?t.map(a=>a===0?"0":a.toExponential(Math.max(0,Math.min(2,Math.round(Math.log10(r/s)))))):t.map(a=>(Math.abs(a)<s/2?0:a).toFixed(o))}function TE(i){if(!Number.isFinite(i))return"\u2013";let t=Math.abs(i);return t!==0&&(t<.001||t>=1e6)?i.toExponential(3):String(+i.toFixed(4))}var EE=100;function fx(i){let t=new au(i),e=U("div",{class:"plots"}),n=[],s=null,r=!1,o=null,a=m=>{s=m;for(let g of n)g.element.classList.toggle("chosen",g===m&&n.length>1)},l=m=>{m.close(),m.element.remove(),n=n.filter(g=>g!==m),a(n.at(-1)??null),h()},c=()=>{let m=new bu(i,t,{close:l,select:a,changed:h});return n.push(m),e.append(m.element),a(m),m},d=()=>`simkit-plots ${i.scene?.world}`,h=()=>{try{localStorage.setItem(d(),JSON.stringify(n.map(m=>m.fields)))}catch{}},u=()=>{try{for(let m of JSON.parse(localStorage.getItem(d()))??[]){let g=c();for(let{topic:y,field:T}of m)g.add(y,T)}}catch{}n.length||c()},f=(m,g)=>(s??c()).add(m,g),p=()=>{o!==null||!r||(o=setTimeout(()=>{if(o=null,r&&!document.hidden)for(let m of n)m.draw()},EE))};t.listeners.push(p);let _=new wu(i,t,f);return _.element.append(U("button",{id:"new-plot",onclick:c},"+ Plot")),i.on("state",()=>{i.player&&p()}),i.on("scene",()=>{r&&t.want()}),matchMedia("(prefers-color-scheme: light)").addEventListener("change",p),i.plots={store:t,list:_,add:c,choose:f,get all(){return n}},u(),{element:U("div",{class:"plot-tab"},_.element,e),show(m){if(r=m,_.setShown(m),t.show(m),m)for(let g of n)g.draw()}}}var px=[["plots","Plots",fx,!0],["console","Console",L0,!0],["calls","Services and actions",E0,!1],["motions","Motions",B0,!1],["parameters","Parameters",k0,!1],["graph","Graph",U0,!1],["frames","Frames",F0,!1]],mx="simkit-dock",AE=120;function gx(i){let t=U("div",{id:"dock-body"}),e=U("div",{id:"dock-grip",title:"Drag to change the height"}),n=U("div",{id:"dock-tabs",role:"tablist"}),s=U("section",{id:"dock","aria-label":"Data"},e,n,t),r=new Map,o=null,a=u=>{o&&r.get(o).show(!1),o=u;for(let[f,[,p]]of l)p.classList.toggle("on",f===u),p.setAttribute("aria-selected",f===u);document.body.classList.toggle("docked",u!==null),u&&!r.has(u)&&r.set(u,px.find(([f])=>f===u)[2](i)),t.replaceChildren(...u?[r.get(u).element]:[]),u&&r.get(u).show(!0),d()},l=new Map(px.map(u=>[u[0],[u,U("button",{id:`tab-${u[0]}`,role:"tab",onclick:()=>a(o===u[0]?null:u[0])},u[1])]])),c=U("button",{id:"dock-close",title:"Close","aria-label":"Close",onclick:()=>a(null)},"\u2715");n.append(...[...l.values()].map(([,u])=>u),U("span",{class:"space"}),c);let d=()=>{try{localStorage.setItem(mx,JSON.stringify([o,t.style.height]))}catch{}},h=u=>{t.style.height=`${Math.round(Math.min(Math.max(u,AE),innerHeight*.75))}px`};e.addEventListener("pointerdown",u=>{e.setPointerCapture(u.pointerId);let f=u.clientY,p=t.clientHeight,_=g=>h(p+f-g.clientY),m=()=>{e.removeEventListener("pointermove",_),d()};e.addEventListener("pointermove",_),e.addEventListener("lostpointercapture",m,{once:!0})}),i.on("scene",u=>{for(let[f,p]of l.values())p.hidden=u.recording&&!f[3]}),i.openTab=a,document.body.append(s);try{let[u,f]=JSON.parse(localStorage.getItem(mx))??[];f&&h(parseFloat(f)),l.has(u)&&i.on("scene",p=>{o===null&&!r.size&&!(p.recording&&!l.get(u)[0][3])&&a(u)})}catch{}return null}var Yr=new di,dn=new R,xr=new R,nn=new ze,_x={X:new R(1,0,0),Y:new R(0,1,0),Z:new R(0,0,1)},dp={type:"change"},xx={type:"mouseDown",mode:null},yx={type:"mouseUp",mode:null},vx={type:"objectChange"},la=class extends Pr{constructor(t,e=null){super(void 0,e);let n=new pp(this);this._root=n;let s=new mp;this._gizmo=s,n.add(s);let r=new gp;this._plane=r,n.add(r);let o=this;function a(T,v){let M=v;Object.defineProperty(o,T,{get:function(){return M!==void 0?M:v},set:function(b){M!==b&&(M=b,r[T]=b,s[T]=b,o.dispatchEvent({type:T+"-changed",value:b}),o.dispatchEvent(dp))}}),o[T]=v,r[T]=v,s[T]=v}a("camera",t),a("object",void 0),a("enabled",!0),a("axis",null),a("mode","translate"),a("translationSnap",null),a("rotationSnap",null),a("scaleSnap",null),a("space","world"),a("size",1),this.viewport=null,a("dragging",!1),a("showX",!0),a("showY",!0),a("showZ",!0),a("showXY",!0),a("showYZ",!0),a("showXZ",!0),a("showXYZE",!0),a("showE",!0),a("minX",-1/0),a("maxX",1/0),a("minY",-1/0),a("maxY",1/0),a("minZ",-1/0),a("maxZ",1/0);let l=new R,c=new R,d=new ze,h=new ze,u=new R,f=new ze,p=new R,_=new R,m=new R,g=0,y=new R;a("worldPosition",l),a("worldPositionStart",c),a("worldQuaternion",d),a("worldQuaternionStart",h),a("cameraPosition",u),a("cameraQuaternion",f),a("pointStart",p),a("pointEnd",_),a("rotationAxis",m),a("rotationAngle",g),a("eye",y),this._offset=new R,this._startNorm=new R,this._endNorm=new R,this._cameraScale=new R,this._parentPosition=new R,this._parentQuaternion=new ze,this._parentQuaternionInv=new ze,this._parentScale=new R,this._worldScaleStart=new R,this._worldQuaternionInv=new ze,this._worldScale=new R,this._positionStart=new R,this._quaternionStart=new ze,this._scaleStart=new R,this._getPointer=CE.bind(this),this._onPointerDown=PE.bind(this),this._onPointerHover=RE.bind(this),this._onPointerMove=IE.bind(this),this._onPointerUp=LE.bind(this),e!==null&&this.connect(e)}connect(t){super.connect(t),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointermove",this._onPointerHover),this.domElement.addEventListener("pointerup",this._onPointerUp),this.domElement.style.touchAction="none"}disconnect(){this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.removeEventListener("pointermove",this._onPointerHover),this.domElement.removeEventListener("pointermove",this._onPointerMove),this.domElement.removeEventListener("pointerup",this._onPointerUp),this.domElement.style.touchAction=""}getHelper(){return this._root}pointerHover(t){if(this.object===void 0||this.dragging===!0)return;t!==null&&Yr.setFromCamera(t,this.camera);let e=fp(this._gizmo.picker[this.mode],Yr);e?this.axis=e.object.name:this.axis=null}pointerDown(t){if(!(this.object===void 0||this.dragging===!0||t!=null&&t.button!==0)&&this.axis!==null){t!==null&&Yr.setFromCamera(t,this.camera);let e=fp(this._plane,Yr,!0);e&&(this.object.updateMatrixWorld(),this.object.parent.updateMatrixWorld(),this._positionStart.copy(this.object.position),this._quaternionStart.copy(this.object.quaternion),this._scaleStart.copy(this.object.scale),this.object.matrixWorld.decompose(this.worldPositionStart,this.worldQuaternionStart,this._worldScaleStart),this.pointStart.copy(e.point).sub(this.worldPositionStart)),this.dragging=!0,xx.mode=this.mode,this.dispatchEvent(xx)}}pointerMove(t){let e=this.axis,n=this.mode,s=this.object,r=this.space;if(n==="scale"?r="local":(e==="E"||e==="XYZE"||e==="XYZ")&&(r="world"),s===void 0||e===null||this.dragging===!1||t!==null&&t.button!==-1)return;t!==null&&Yr.setFromCamera(t,this.camera);let o=fp(this._plane,Yr,!0);if(o){if(this.pointEnd.copy(o.point).sub(this.worldPositionStart),n==="translate")this._offset.copy(this.pointEnd).sub(this.pointStart),r==="local"&&e!=="XYZ"&&this._offset.applyQuaternion(this._worldQuaternionInv),e.indexOf("X")===-1&&(this._offset.x=0),e.indexOf("Y")===-1&&(this._offset.y=0),e.indexOf("Z")===-1&&(this._offset.z=0),r==="local"&&e!=="XYZ"?this._offset.applyQuaternion(this._quaternionStart).divide(this._parentScale):this._offset.applyQuaternion(this._parentQuaternionInv).divide(this._parentScale),s.position.copy(this._offset).add(this._positionStart),this.translationSnap&&(r==="local"&&(s.position.applyQuaternion(nn.copy(this._quaternionStart).invert()),e.search("X")!==-1&&(s.position.x=Math.round(s.position.x/this.translationSnap)*this.translationSnap),e.search("Y")!==-1&&(s.position.y=Math.round(s.position.y/this.translationSnap)*this.translationSnap),e.search("Z")!==-1&&(s.position.z=Math.round(s.position.z/this.translationSnap)*this.translationSnap),s.position.applyQuaternion(this._quaternionStart)),r==="world"&&(s.getWorldPosition(dn),e.search("X")!==-1&&(dn.x=Math.round(dn.x/this.translationSnap)*this.translationSnap),e.search("Y")!==-1&&(dn.y=Math.round(dn.y/this.translationSnap)*this.translationSnap),e.search("Z")!==-1&&(dn.z=Math.round(dn.z/this.translationSnap)*this.translationSnap),s.position.copy(s.parent.worldToLocal(dn)))),s.position.x=Math.max(this.minX,Math.min(this.maxX,s.position.x)),s.position.y=Math.max(this.minY,Math.min(this.maxY,s.position.y)),s.position.z=Math.max(this.minZ,Math.min(this.maxZ,s.position.z));else if(n==="scale"){if(e.search("XYZ")!==-1){let a=this.pointEnd.length()/this.pointStart.length();this.pointEnd.dot(this.pointStart)<0&&(a*=-1),xr.set(a,a,a)}else dn.copy(this.pointStart),xr.copy(this.pointEnd),dn.applyQuaternion(this._worldQuaternionInv),xr.applyQuaternion(this._worldQuaternionInv),xr.divide(dn),e.search("X")===-1&&(xr.x=1),e.search("Y")===-1&&(xr.y=1),e.search("Z")===-1&&(xr.z=1);s.scale.copy(this._scaleStart).multiply(xr),this.scaleSnap&&(e.search("X")!==-1&&(s.scale.x=Math.round(s.scale.x/this.scaleSnap)*this.scaleSnap||this.scaleSnap),e.search("Y")!==-1&&(s.scale.y=Math.round(s.scale.y/this.scaleSnap)*this.scaleSnap||this.scaleSnap),e.search("Z")!==-1&&(s.scale.z=Math.round(s.scale.z/this.scaleSnap)*this.scaleSnap||this.scaleSnap))}else if(n==="rotate"){this._offset.copy(this.pointEnd).sub(this.pointStart);let a=20/this.worldPosition.distanceTo(dn.setFromMatrixPosition(this.camera.matrixWorld)),l=!1;e==="XYZE"?(this.rotationAxis.copy(this._offset).cross(this.eye).normalize(),this.rotationAngle=this._offset.dot(dn.copy(this.rotationAxis).cross(this.eye))*a):(e==="X"||e==="Y"||e==="Z")&&(this.rotationAxis.copy(_x[e]),dn.copy(_x[e]),r==="local"&&dn.applyQuaternion(this.worldQuaternion),dn.cross(this.eye),dn.length()===0?l=!0:this.rotationAngle=this._offset.dot(dn.normalize())*a),(e==="E"||l)&&(this.rotationAxis.copy(this.eye),this.rotationAngle=this.pointEnd.angleTo(this.pointStart),this._startNorm.copy(this.pointStart).normalize(),this._endNorm.copy(this.pointEnd).normalize(),this.rotationAngle*=this._endNorm.cross(this._startNorm).dot(this.eye)<0?1:-1),this.rotationSnap&&(this.rotationAngle=Math.round(this.rotationAngle/this.rotationSnap)*this.rotationSnap),r==="local"&&e!=="E"&&e!=="XYZE"?(s.quaternion.copy(this._quaternionStart),s.quaternion.multiply(nn.setFromAxisAngle(this.rotationAxis,this.rotationAngle)).normalize()):(this.rotationAxis.applyQuaternion(this._parentQuaternionInv),s.quaternion.copy(nn.setFromAxisAngle(this.rotationAxis,this.rotationAngle)),s.quaternion.multiply(this._quaternionStart).normalize())}this.dispatchEvent(dp),this.dispatchEvent(vx)}}pointerUp(t){t!==null&&t.button!==0||(this.dragging&&this.axis!==null&&(yx.mode=this.mode,this.dispatchEvent(yx)),this.dragging=!1,this.axis=null)}dispose(){this.disconnect(),this._root.dispose()}attach(t){return this.object=t,this._root.visible=!0,this}detach(){return this.object=void 0,this.axis=null,this._root.visible=!1,this}reset(){this.enabled&&this.dragging&&(this.object.position.copy(this._positionStart),this.object.quaternion.copy(this._quaternionStart),this.object.scale.copy(this._scaleStart),this.dispatchEvent(dp),this.dispatchEvent(vx),this.pointStart.copy(this.pointEnd))}getRaycaster(){return Yr}getMode(){return this.mode}setMode(t){this.mode=t}setTranslationSnap(t){this.translationSnap=t}setRotationSnap(t){this.rotationSnap=t}setScaleSnap(t){this.scaleSnap=t}setSize(t){this.size=t}setSpace(t){this.space=t}setColors(t,e,n,s){let r=this._gizmo.materialLib;r.xAxis.color.set(t),r.yAxis.color.set(e),r.zAxis.color.set(n),r.active.color.set(s),r.xAxisTransparent.color.set(t),r.yAxisTransparent.color.set(e),r.zAxisTransparent.color.set(n),r.activeTransparent.color.set(s),r.xAxis._color&&r.xAxis._color.set(t),r.yAxis._color&&r.yAxis._color.set(e),r.zAxis._color&&r.zAxis._color.set(n),r.active._color&&r.active._color.set(s),r.xAxisTransparent._color&&r.xAxisTransparent._color.set(t),r.yAxisTransparent._color&&r.yAxisTransparent._color.set(e),r.zAxisTransparent._color&&r.zAxisTransparent._color.set(n),r.activeTransparent._color&&r.activeTransparent._color.set(s)}};function CE(i){if(this.domElement.ownerDocument.pointerLockElement)return{x:0,y:0,button:i.button};{let t=this.domElement.getBoundingClientRect(),e=this.viewport,n,s,r,o;return e!==null?(n=e.x,s=t.height-e.y-e.w,r=e.z,o=e.w):(n=0,s=0,r=t.width,o=t.height),{x:(i.clientX-t.left-n)/r*2-1,y:-(i.clientY-t.top-s)/o*2+1,button:i.button}}}function RE(i){if(this.enabled)switch(i.pointerType){case"mouse":case"pen":this.pointerHover(this._getPointer(i));break}}function PE(i){this.enabled&&(document.pointerLockElement||this.domElement.setPointerCapture(i.pointerId),this.domElement.addEventListener("pointermove",this._onPointerMove),this.pointerHover(this._getPointer(i)),this.pointerDown(this._getPointer(i)))}function IE(i){this.enabled&&this.pointerMove(this._getPointer(i))}function LE(i){this.enabled&&(this.domElement.releasePointerCapture(i.pointerId),this.domElement.removeEventListener("pointermove",this._onPointerMove),this.pointerUp(this._getPointer(i)))}function fp(i,t,e){let n=t.intersectObject(i,!0);for(let s=0;s<n.length;s++)if(n[s].object.visible||e)return n[s];return!1}var Tu=new Qn,We=new R(0,1,0),Sx=new R(0,0,0),Mx=new Wt,Eu=new ze,Cu=new ze,vs=new R,Ru=new Wt,Ll=new R(1,0,0),qr=new R(0,1,0),Dl=new R(0,0,1),Au=new R,Pl=new R,Il=new R,pp=class extends Ee{constructor(t){super(),this.isTransformControlsRoot=!0,this.controls=t,this.visible=!1}updateMatrixWorld(t){let e=this.controls;e.object!==void 0&&(e.object.updateMatrixWorld(),e.object.parent===null?console.error("TransformControls: The attached 3D object must be a part of the scene graph."):e.object.parent.matrixWorld.decompose(e._parentPosition,e._parentQuaternion,e._parentScale),e.object.matrixWorld.decompose(e.worldPosition,e.worldQuaternion,e._worldScale),e._parentQuaternionInv.copy(e._parentQuaternion).invert(),e._worldQuaternionInv.copy(e.worldQuaternion).invert()),e.camera.updateMatrixWorld(),e.camera.matrixWorld.decompose(e.cameraPosition,e.cameraQuaternion,e._cameraScale),e.camera.isOrthographicCamera?e.camera.getWorldDirection(e.eye).negate():e.eye.copy(e.cameraPosition).sub(e.worldPosition).normalize(),this.parent&&(Ru.copy(this.parent.matrixWorld).invert(),Ru.decompose(this.position,this.quaternion,this.scale)),super.updateMatrixWorld(t)}dispose(){this.traverse(function(t){t.geometry&&t.geometry.dispose(),t.material&&t.material.dispose()})}},mp=class extends Ee{constructor(){super(),this.isTransformControlsGizmo=!0,this.type="TransformControlsGizmo";let t=new Vn({depthTest:!1,depthWrite:!1,fog:!1,toneMapped:!1,transparent:!0}),e=new Ai({depthTest:!1,depthWrite:!1,fog:!1,toneMapped:!1,transparent:!0}),n=t.clone();n.opacity=.15;let s=e.clone();s.opacity=.5;let r=t.clone();r.color.setHex(16711680);let o=t.clone();o.color.setHex(65280);let a=t.clone();a.color.setHex(255);let l=t.clone();l.color.setHex(16711680),l.opacity=.5;let c=t.clone();c.color.setHex(65280),c.opacity=.5;let d=t.clone();d.color.setHex(255),d.opacity=.5;let h=t.clone();h.opacity=.25;let u=t.clone();u.color.setHex(16776960),u.opacity=.25;let f=t.clone();f.color.setHex(16776960);let p=t.clone();p.color.setHex(7895160),this.materialLib={xAxis:r,yAxis:o,zAxis:a,active:f,xAxisTransparent:l,yAxisTransparent:c,zAxisTransparent:d,activeTransparent:u};let _=new rn(0,.04,.1,12);_.translate(0,.05,0);let m=new Ye(.08,.08,.08);m.translate(0,.04,0);let g=new pe;g.setAttribute("position",new ie([0,0,0,1,0,0],3));let y=new rn(.0075,.0075,.5,3);y.translate(0,.25,0);function T(X,Z){let W=new Bs(X,.0075,3,64,Z*Math.PI*2);return W.rotateY(Math.PI/2),W.rotateX(Math.PI/2),W}function v(){let X=new pe;return X.setAttribute("position",new ie([0,0,0,1,1,1],3)),X}let M={X:[[new St(_,r),[.5,0,0],[0,0,-Math.PI/2]],[new St(_,r),[-.5,0,0],[0,0,Math.PI/2]],[new St(y,r),[0,0,0],[0,0,-Math.PI/2]]],Y:[[new St(_,o),[0,.5,0]],[new St(_,o),[0,-.5,0],[Math.PI,0,0]],[new St(y,o)]],Z:[[new St(_,a),[0,0,.5],[Math.PI/2,0,0]],[new St(_,a),[0,0,-.5],[-Math.PI/2,0,0]],[new St(y,a),null,[Math.PI/2,0,0]]],XYZ:[[new St(new rr(.1,0),h),[0,0,0]]],XY:[[new St(new Ye(.15,.15,.01),d),[.15,.15,0]]],YZ:[[new St(new Ye(.15,.15,.01),l),[0,.15,.15],[0,Math.PI/2,0]]],XZ:[[new St(new Ye(.15,.15,.01),c),[.15,0,.15],[-Math.PI/2,0,0]]]},b={X:[[new St(new rn(.2,0,.6,4),n),[.3,0,0],[0,0,-Math.PI/2]],[new St(new rn(.2,0,.6,4),n),[-.3,0,0],[0,0,Math.PI/2]]],Y:[[new St(new rn(.2,0,.6,4),n),[0,.3,0]],[new St(new rn(.2,0,.6,4),n),[0,-.3,0],[0,0,Math.PI]]],Z:[[new St(new rn(.2,0,.6,4),n),[0,0,.3],[Math.PI/2,0,0]],[new St(new rn(.2,0,.6,4),n),[0,0,-.3],[-Math.PI/2,0,0]]],XYZ:[[new St(new rr(.2,0),n)]],XY:[[new St(new Ye(.2,.2,.01),n),[.15,.15,0]]],YZ:[[new St(new Ye(.2,.2,.01),n),[0,.15,.15],[0,Math.PI/2,0]]],XZ:[[new St(new Ye(.2,.2,.01),n),[.15,0,.15],[-Math.PI/2,0,0]]]},x={START:[[new St(new rr(.01,2),s),null,null,null,"helper"]],END:[[new St(new rr(.01,2),s),null,null,null,"helper"]],DELTA:[[new ti(v(),s),null,null,null,"helper"]],X:[[new ti(g,s),[-1e3,0,0],null,[1e6,1,1],"helper"]],Y:[[new ti(g,s),[0,-1e3,0],[0,0,Math.PI/2],[1e6,1,1],"helper"]],Z:[[new ti(g,s),[0,0,-1e3],[0,-Math.PI/2,0],[1e6,1,1],"helper"]]},w={XYZE:[[new St(T(.5,1),p),null,[0,Math.PI/2,0]]],X:[[new St(T(.5,.5),r)]],Y:[[new St(T(.5,.5),o),null,[0,0,-Math.PI/2]]],Z:[[new St(T(.5,.5),a),null,[0,Math.PI/2,0]]],E:[[new St(T(.75,1),u),null,[0,Math.PI/2,0]]]},O={AXIS:[[new ti(g,s),[-1e3,0,0],null,[1e6,1,1],"helper"]]},P={XYZE:[[new St(new hi(.25,10,8),n)]],X:[[new St(new Bs(.5,.1,4,24),n),[0,0,0],[0,-Math.PI/2,-Math.PI/2]]],Y:[[new St(new Bs(.5,.1,4,24),n),[0,0,0],[Math.PI/2,0,0]]],Z:[[new St(new Bs(.5,.1,4,24),n),[0,0,0],[0,0,-Math.PI/2]]],E:[[new St(new Bs(.75,.1,2,24),n)]]},L={X:[[new St(m,r),[.5,0,0],[0,0,-Math.PI/2]],[new St(y,r),[0,0,0],[0,0,-Math.PI/2]],[new St(m,r),[-.5,0,0],[0,0,Math.PI/2]]],Y:[[new St(m,o),[0,.5,0]],[new St(y,o)],[new St(m,o),[0,-.5,0],[0,0,Math.PI]]],Z:[[new St(m,a),[0,0,.5],[Math.PI/2,0,0]],[new St(y,a),[0,0,0],[Math.PI/2,0,0]],[new St(m,a),[0,0,-.5],[-Math.PI/2,0,0]]],XY:[[new St(new Ye(.15,.15,.01),d),[.15,.15,0]]],YZ:[[new St(new Ye(.15,.15,.01),l),[0,.15,.15],[0,Math.PI/2,0]]],XZ:[[new St(new Ye(.15,.15,.01),c),[.15,0,.15],[-Math.PI/2,0,0]]],XYZ:[[new St(new Ye(.1,.1,.1),h)]]},B={X:[[new St(new rn(.2,0,.6,4),n),[.3,0,0],[0,0,-Math.PI/2]],[new St(new rn(.2,0,.6,4),n),[-.3,0,0],[0,0,Math.PI/2]]],Y:[[new St(new rn(.2,0,.6,4),n),[0,.3,0]],[new St(new rn(.2,0,.6,4),n),[0,-.3,0],[0,0,Math.PI]]],Z:[[new St(new rn(.2,0,.6,4),n),[0,0,.3],[Math.PI/2,0,0]],[new St(new rn(.2,0,.6,4),n),[0,0,-.3],[-Math.PI/2,0,0]]],XY:[[new St(new Ye(.2,.2,.01),n),[.15,.15,0]]],YZ:[[new St(new Ye(.2,.2,.01),n),[0,.15,.15],[0,Math.PI/2,0]]],XZ:[[new St(new Ye(.2,.2,.01),n),[.15,0,.15],[-Math.PI/2,0,0]]],XYZ:[[new St(new Ye(.2,.2,.2),n),[0,0,0]]]},G={X:[[new ti(g,s),[-1e3,0,0],null,[1e6,1,1],"helper"]],Y:[[new ti(g,s),[0,-1e3,0],[0,0,Math.PI/2],[1e6,1,1],"helper"]],Z:[[new ti(g,s),[0,0,-1e3],[0,-Math.PI/2,0],[1e6,1,1],"helper"]]};function D(X){let Z=new Ee;for(let W in X)for(let at=X[W].length;at--;){let k=X[W][at][0].clone(),q=X[W][at][1],Q=X[W][at][2],lt=X[W][at][3],ht=X[W][at][4];k.name=W,k.tag=ht,q&&k.position.set(q[0],q[1],q[2]),Q&&k.rotation.set(Q[0],Q[1],Q[2]),lt&&k.scale.set(lt[0],lt[1],lt[2]),k.updateMatrix();let et=k.geometry.clone();et.applyMatrix4(k.matrix),k.geometry=et,k.renderOrder=1/0,k.position.set(0,0,0),k.rotation.set(0,0,0),k.scale.set(1,1,1),Z.add(k)}return Z}this.gizmo={},this.picker={},this.helper={},this.add(this.gizmo.translate=D(M)),this.add(this.gizmo.rotate=D(w)),this.add(this.gizmo.scale=D(L)),this.add(this.picker.translate=D(b)),this.add(this.picker.rotate=D(P)),this.add(this.picker.scale=D(B)),this.add(this.helper.translate=D(x)),this.add(this.helper.rotate=D(O)),this.add(this.helper.scale=D(G)),this.picker.translate.visible=!1,this.picker.rotate.visible=!1,this.picker.scale.visible=!1}updateMatrixWorld(t){let n=(this.mode==="scale"?"local":this.space)==="local"?this.worldQuaternion:Cu;this.gizmo.translate.visible=this.mode==="translate",this.gizmo.rotate.visible=this.mode==="rotate",this.gizmo.scale.visible=this.mode==="scale",this.helper.translate.visible=this.mode==="translate",this.helper.rotate.visible=this.mode==="rotate",this.helper.scale.visible=this.mode==="scale";let s=[];s=s.concat(this.picker[this.mode].children),s=s.concat(this.gizmo[this.mode].children),s=s.concat(this.helper[this.mode].children);for(let r=0;r<s.length;r++){let o=s[r];o.visible=!0,o.rotation.set(0,0,0),o.position.copy(this.worldPosition);let a;if(this.camera.isOrthographicCamera?a=(this.camera.top-this.camera.bottom)/this.camera.zoom:a=this.worldPosition.distanceTo(this.cameraPosition)*Math.min(1.9*Math.tan(Math.PI*this.camera.fov/360)/this.camera.zoom,7),o.scale.set(1,1,1).multiplyScalar(a*this.size/4),o.tag==="helper"){o.visible=!1,o.name==="AXIS"?(o.visible=!!this.axis,this.axis==="X"&&(nn.setFromEuler(Tu.set(0,0,0)),o.quaternion.copy(n).multiply(nn),Math.abs(We.copy(Ll).applyQuaternion(n).dot(this.eye))>.9&&(o.visible=!1)),this.axis==="Y"&&(nn.setFromEuler(Tu.set(0,0,Math.PI/2)),o.quaternion.copy(n).multiply(nn),Math.abs(We.copy(qr).applyQuaternion(n).dot(this.eye))>.9&&(o.visible=!1)),this.axis==="Z"&&(nn.setFromEuler(Tu.set(0,Math.PI/2,0)),o.quaternion.copy(n).multiply(nn),Math.abs(We.copy(Dl).applyQuaternion(n).dot(this.eye))>.9&&(o.visible=!1)),this.axis==="XYZE"&&(nn.setFromEuler(Tu.set(0,Math.PI/2,0)),We.copy(this.rotationAxis),o.quaternion.setFromRotationMatrix(Mx.lookAt(Sx,We,qr)),o.quaternion.multiply(nn),o.visible=this.dragging),this.axis==="E"&&(o.visible=!1)):o.name==="START"?(o.position.copy(this.worldPositionStart),o.visible=this.dragging):o.name==="END"?(o.position.copy(this.worldPosition),o.visible=this.dragging):o.name==="DELTA"?(o.position.copy(this.worldPositionStart),o.quaternion.copy(this.worldQuaternionStart),dn.set(1e-10,1e-10,1e-10).add(this.worldPositionStart).sub(this.worldPosition).multiplyScalar(-1),dn.applyQuaternion(this.worldQuaternionStart.clone().invert()),o.scale.copy(dn),o.visible=this.dragging):(o.quaternion.copy(n),this.dragging?o.position.copy(this.worldPositionStart):o.position.copy(this.worldPosition),this.axis&&(o.visible=this.axis.search(o.name)!==-1));continue}o.quaternion.copy(n),this.mode==="translate"||this.mode==="scale"?(o.name==="X"&&Math.abs(We.copy(Ll).applyQuaternion(n).dot(this.eye))>.99&&(o.scale.set(1e-10,1e-10,1e-10),o.visible=!1),o.name==="Y"&&Math.abs(We.copy(qr).applyQuaternion(n).dot(this.eye))>.99&&(o.scale.set(1e-10,1e-10,1e-10),o.visible=!1),o.name==="Z"&&Math.abs(We.copy(Dl).applyQuaternion(n).dot(this.eye))>.99&&(o.scale.set(1e-10,1e-10,1e-10),o.visible=!1),o.name==="XY"&&Math.abs(We.copy(Dl).applyQuaternion(n).dot(this.eye))<.2&&(o.scale.set(1e-10,1e-10,1e-10),o.visible=!1),o.name==="YZ"&&Math.abs(We.copy(Ll).applyQuaternion(n).dot(this.eye))<.2&&(o.scale.set(1e-10,1e-10,1e-10),o.visible=!1),o.name==="XZ"&&Math.abs(We.copy(qr).applyQuaternion(n).dot(this.eye))<.2&&(o.scale.set(1e-10,1e-10,1e-10),o.visible=!1)):this.mode==="rotate"&&(Eu.copy(n),We.copy(this.eye).applyQuaternion(nn.copy(n).invert()),o.name.search("E")!==-1&&o.quaternion.setFromRotationMatrix(Mx.lookAt(this.eye,Sx,qr)),o.name==="X"&&(nn.setFromAxisAngle(Ll,Math.atan2(-We.y,We.z)),nn.multiplyQuaternions(Eu,nn),o.quaternion.copy(nn)),o.name==="Y"&&(nn.setFromAxisAngle(qr,Math.atan2(We.x,We.z)),nn.multiplyQuaternions(Eu,nn),o.quaternion.copy(nn)),o.name==="Z"&&(nn.setFromAxisAngle(Dl,Math.atan2(We.y,We.x)),nn.multiplyQuaternions(Eu,nn),o.quaternion.copy(nn))),o.visible=o.visible&&(o.name.indexOf("X")===-1||this.showX),o.visible=o.visible&&(o.name.indexOf("Y")===-1||this.showY),o.visible=o.visible&&(o.name.indexOf("Z")===-1||this.showZ),o.visible=o.visible&&(o.name.indexOf("E")===-1||this.showX&&this.showY&&this.showZ),o.visible=o.visible&&(o.name.indexOf("XY")===-1||this.showXY),o.visible=o.visible&&(o.name.indexOf("YZ")===-1||this.showYZ),o.visible=o.visible&&(o.name.indexOf("XZ")===-1||this.showXZ),o.visible=o.visible&&(o.name!=="E"||this.showE),o.visible=o.visible&&(o.name!=="XYZE"||this.showXYZE),o.material._color=o.material._color||o.material.color.clone(),o.material._opacity=o.material._opacity||o.material.opacity,o.material.color.copy(o.material._color),o.material.opacity=o.material._opacity,this.enabled&&this.axis&&(o.name===this.axis?(o.material.color.copy(this.materialLib.active.color),o.material.opacity=1):this.axis.split("").some(function(l){return o.name===l})&&(o.material.color.copy(this.materialLib.active.color),o.material.opacity=1))}super.updateMatrixWorld(t)}},gp=class extends St{constructor(){super(new gi(1e5,1e5,2,2),new Vn({visible:!1,wireframe:!0,side:Mn,transparent:!0,opacity:.1,toneMapped:!1})),this.isTransformControlsPlane=!0,this.type="TransformControlsPlane"}updateMatrixWorld(t){let e=this.space;switch(this.position.copy(this.worldPosition),this.mode==="scale"&&(e="local"),Au.copy(Ll).applyQuaternion(e==="local"?this.worldQuaternion:Cu),Pl.copy(qr).applyQuaternion(e==="local"?this.worldQuaternion:Cu),Il.copy(Dl).applyQuaternion(e==="local"?this.worldQuaternion:Cu),We.copy(Pl),this.mode){case"translate":case"scale":switch(this.axis){case"X":We.copy(this.eye).cross(Au),vs.copy(Au).cross(We);break;case"Y":We.copy(this.eye).cross(Pl),vs.copy(Pl).cross(We);break;case"Z":We.copy(this.eye).cross(Il),vs.copy(Il).cross(We);break;case"XY":vs.copy(Il);break;case"YZ":vs.copy(Au);break;case"XZ":We.copy(Il),vs.copy(Pl);break;case"XYZ":case"E":vs.set(0,0,0);break}break;default:vs.set(0,0,0)}vs.length()===0?this.quaternion.copy(this.cameraQuaternion):(Ru.lookAt(dn.set(0,0,0),vs,We),this.quaternion.setFromRotationMatrix(Ru)),super.updateMatrixWorld(t)}};var DE=60,NE=["showX","showY","showZ"],Pu=class{constructor(t){this.app=t,this.proxy=new Ee,this.gizmo=new la(t.stage.camera,t.stage.canvas),this.gizmo.setSize(.7),this.edited=null,this.timer=null,t.stage.helpers.add(this.proxy,this.gizmo.getHelper()),this.gizmo.addEventListener("change",()=>t.stage.invalidate()),this.gizmo.addEventListener("objectChange",()=>{this.timer??=setTimeout(()=>this.send("pose_update"),DE)}),this.gizmo.addEventListener("dragging-changed",({value:e})=>{t.stage.controls.enabled=!e&&t.views.sensor===null,e?this.send("mouse_down"):(clearTimeout(this.timer),this.send("pose_update"),this.send("mouse_up"))}),t.on("displays",()=>this.follow())}row(t){let e=(s,r)=>U("button",{"data-marker":`${s} ${t.name}`,onclick:()=>this.edit(t,s)},r),n=U("div",{class:"row"});if(t.move.includes(!0)&&n.append(e("translate","Move")),t.turn.includes(!0)&&n.append(e("rotate","Turn")),t.button&&n.append(U("button",{"data-marker":`click ${t.name}`,onclick:()=>this.event(t,"button_click")},"Click")),t.menu.length){let s=new Set(t.menu.map(([,c])=>c)),r=new Map(t.menu.map(([c,d,h])=>[c,[d,h]])),o=c=>{let[d,h]=r.get(c);return r.has(d)?`${o(d)} \u203A ${h}`:h},a=t.menu.filter(([c])=>!s.has(c)).map(([c])=>U("option",{value:c},o(c))),l=U("select",{"data-marker":`menu ${t.name}`,onchange:()=>{this.event(t,"menu_select",+l.value),l.selectedIndex=0}},U("option",{value:""},"Menu \u2026"),...a);n.append(l)}return U("div",{class:"marker"},U("div",{class:"dim"},t.description),n)}newest(t){return this.app.displays.handles(t.topic).find(e=>e.name===t.name)??null}place(t,e){on(t.pose,0,e).premultiply(on(t.offset,0,new Wt));let n=this.app.world.bodies[t.body];return n?e.premultiply(n):e}edit(t,e){let n=this.edited?.name===t.name&&this.edited.topic===t.topic&&this.gizmo.mode===e;if(this.end(),n)return;this.app.modelEditor?.end(),this.edited={topic:t.topic,name:t.name};let s=e==="translate"?t.move:t.turn;NE.forEach((r,o)=>{this.gizmo[r]=s[o]}),this.gizmo.setMode(e),this.gizmo.setSpace(t.space),this.follow(),this.gizmo.attach(this.proxy),this.app.clickMode=r=>{this.gizmo.axis||(this.end(),this.app.select(r&&!r.isFloor?r.link:null))},this.app.stage.invalidate()}follow(){if(!this.edited||this.gizmo.dragging)return;let t=this.newest(this.edited);if(!t){this.end();return}this.place(t,this.proxy.matrix).decompose(this.proxy.position,this.proxy.quaternion,this.proxy.scale)}end(){this.edited&&(this.app.clickMode=null),this.edited=null,this.gizmo.detach(),this.app.stage.invalidate()}send(t){if(this.timer=null,!this.edited)return;let{x:e,y:n,z:s,w:r}=this.proxy.quaternion;this.app.send("marker",{...this.edited,event:t,pose:[...this.proxy.position.toArray(),r,e,n,s]})}event(t,e,n=0){let s=this.newest(t),r=new R,o=new ze;s&&(this.place(s,new Wt).decompose(r,o,new R),this.app.send("marker",{topic:s.topic,name:s.name,event:e,entry:n,pose:[...r.toArray(),o.w,o.x,o.y,o.z]}))}};function wx(i){let t=U("div",{class:"displays"}),e=ni("displays","Topics in the scene",t),n=new Map,s=i.markerHandles=new Pu(i),r=(l,c)=>{let d=Jo(`display-${l}`,l,i.displays.wanted.has(l),f=>i.displays.set(l,f));d.title=c;let h=U("div",{class:"dim problem"}),u=U("div",{class:"markers"});return{type:c,check:d,problems:h,markers:u,shown:"",element:U("div",{},d,h,u)}},o=(l,c)=>{let d=i.player?[]:i.displays.handles(l),h=JSON.stringify(d.map(({name:u,description:f,move:p,turn:_,button:m,menu:g})=>[u,f,p,_,m,g]));h!==c.shown&&(c.shown=h,c.markers.replaceChildren(...d.map(u=>s.row(u))))},a=()=>{let{topics:l}=i.displays,c=new Set(l.map(([h])=>h));for(let h of n.keys())!c.has(h)&&!i.displays.wanted.has(h)&&n.delete(h);for(let[h,u]of l)n.get(h)?.type!==u&&n.set(h,r(h,u));for(let[h,u]of n)u.problems.textContent=i.displays.problems(h).join("; "),o(h,u);let d=[...n].sort(([h],[u])=>h<u?-1:1).map(([,h])=>h.element);(d.length!==t.children.length||d.some((h,u)=>h!==t.children[u]))&&t.replaceChildren(...d),e.hidden=n.size===0};return i.on("displays",a),i.on("scene",()=>{i.player||i.connection.want("displays",{})}),i.on("recording",l=>{i.displays.topics=l.displayTopics(),a()}),e.hidden=!0,e}var bx={w:"w",x:"x",a:"a",d:"d",s:"s",j:"j",l:"l",q:"q",z:"z",ArrowUp:"up",ArrowDown:"down",ArrowLeft:"left",ArrowRight:"right"},OE=200;function Tx(i){let t=U("select",{id:"target",title:"Robot",onchange:()=>T()}),e=U("div",{class:"knob"}),n=U("div",{id:"pad",class:"pad",title:"Drag to drive"},e),s=U("div",{id:"speeds",class:"dim"}),r=U("button",{id:"stop",onclick:()=>v("s")},"Stop (s)"),o=U("button",{id:"go",title:"Click on the ground, drag for the direction",onclick:()=>P("goal",o)},"Go there"),a=U("button",{id:"here",title:"Click on the ground, drag for the direction",onclick:()=>P("initial",a)},"I am here"),l=U("div",{id:"pose-answer",class:"dim"}),c=U("div",{class:"dim keys"},"w a s d x or arrows: drive"),d=U("div",{class:"driving"},t,n,s,r),h=ni("drive","Drive",d,c,U("div",{class:"row"},o,a),l),u=[],f={},p=null,_=[0,0],m=()=>u[t.selectedIndex],g=()=>{if(!m())return;let[[k,q,Q],lt,ht]=f[m().topic]??[[0,0,0],null,""],et=[`${k.toFixed(2)} m/s`,...m().sideways?[`${q.toFixed(2)} m/s left`]:[],`${Q.toFixed(2)} rad/s`],mt=lt===null||!(k||q||Q)?0:(i.state?.time??lt)-lt;s.textContent=et.join("  ")+(ht?`, stopped: ${ht}`:mt>1?`, sent ${mt.toFixed(0)} s ago`:""),s.title=`Command on ${m().topic}`},y=()=>i.connection.want("driving",h.open&&!h.hidden?{}:null),T=()=>{d.hidden=c.hidden=u.length===0,t.hidden=u.length<2,h.hidden=u.length===0,g(),y()},v=k=>{m()&&i.send("key",{topic:m().topic,key:k})},M=()=>{if(!m())return;let k=(q,Q,lt)=>Q*Math.abs((Q>0?q[1]:q[0])??lt);i.send("drive",{topic:m().topic,ahead:k(m().linear,_[0],1),turn:k(m().angular,_[1],1.5)})},b=k=>{let q=n.getBoundingClientRect(),Q=2*(k.clientX-q.left)/q.width-1,lt=2*(k.clientY-q.top)/q.height-1,ht=Math.hypot(Q,lt);ht>1&&(Q/=ht,lt/=ht),e.style.translate=`${36*Q}px ${36*lt}px`,_=[-lt,-Q]},x=()=>{p!==null&&(clearInterval(p),p=null,e.style.translate="0 0",v("s"))};n.addEventListener("pointerdown",k=>{n.setPointerCapture(k.pointerId),b(k),M(),p??=setInterval(M,OE)}),n.addEventListener("pointermove",k=>{p!==null&&b(k)});for(let k of["pointerup","pointercancel","lostpointercapture"])n.addEventListener(k,x);addEventListener("blur",x),addEventListener("keydown",k=>{if(!Jh(k))return;let q=bx[k.key]??bx[k.key.toLowerCase()];q&&u.length&&(k.preventDefault(),v(q))});let w=new rl(new R(1,0,0),new R,.5,3199320,.18,.12);w.visible=!1,i.stage.helpers.add(w);let O=null,P=(k,q)=>{let Q=i.aiming===k;L(),!Q&&(O=i.aiming=k,q.classList.add("on"),i.stage.controls.enabled=!1,i.stage.canvas.style.cursor="crosshair",l.textContent="click on the ground and drag for the direction",l.className="dim")},L=()=>{O=i.aiming=null,o.classList.remove("on"),a.classList.remove("on"),i.stage.controls.enabled=i.views.sensor===null,i.stage.canvas.style.cursor="",l.textContent=""};addEventListener("keydown",k=>{k.key==="Escape"&&O&&L()});let B=k=>{let q=i.pickAt(k.clientX,k.clientY);if(q)return q.point;let Q=i.stage.canvas.getBoundingClientRect(),lt=new di;return lt.setFromCamera(new Bt(2*(k.clientX-Q.left)/Q.width-1,1-2*(k.clientY-Q.top)/Q.height),i.stage.camera),lt.ray.intersectPlane(new En(new R(0,0,1),0),new R)},G=null,D=i.stage.canvas;D.addEventListener("pointerdown",k=>{G=O?B(k):null,G&&(D.setPointerCapture(k.pointerId),w.position.copy(G).setZ(G.z+.05),w.setColor(O==="goal"?3199320:5809919),w.visible=!0,i.stage.invalidate())});let X=k=>{let q=B(k);return q&&q.distanceTo(G)>.1?Math.atan2(q.y-G.y,q.x-G.x):0};D.addEventListener("pointermove",k=>{if(!G)return;let q=X(k);w.setDirection(new R(Math.cos(q),Math.sin(q),0)),i.stage.invalidate()}),D.addEventListener("pointerup",k=>{!G||!O||(k.stopImmediatePropagation(),i.ask("pose",{kind:O,x:G.x,y:G.y,yaw:X(k)}).then(Z,q=>i.report(q.message)),G=null,L())});let Z=({topic:k,missing:q})=>{l.textContent=q||`published on ${k}${i.state.paused?"; the world is paused":""}`,l.className=q?"problem":"dim",q&&i.report(q)},W=0;i.on("state",({tick:k})=>{k<W&&(w.visible=!1,l.textContent="",i.stage.invalidate()),W=k}),i.on("scene",()=>i.ask("targets").then(k=>at(k)).catch(()=>{})),i.on("link",k=>{k&&i.ask("targets").then(q=>at(q)).catch(()=>{})});let at=k=>{let q=m()?.topic;u=k,t.replaceChildren(...k.map(Q=>U("option",{},Q.model||Q.topic))),t.selectedIndex=Math.max(0,k.findIndex(Q=>Q.topic===q)),T()};return i.on("packet:driving",k=>{f=k.commands,g()}),i.on("state",g),h.addEventListener("toggle",y),h.hidden=!0,h}var UE=80;function Ex(i){let t=U("div",{class:"joints"}),e=ni("joints","Joints",t),n=[];i.jointPositions=[];let s=h=>h.type!=="prismatic",r=(h,u)=>s(h)?`${_s(u*180/Math.PI,1)}\xB0`:`${_s(u,3)} m`,o=(h,u)=>{let f=h.type==="continuous"||h.lower===null||h.upper===null?[-Math.PI,Math.PI]:[h.lower,h.upper],p=U("output",{class:"dim"}),_=U("input",{type:"range",min:f[0],max:f[1],step:(f[1]-f[0])/500,"aria-label":h.name,"data-joint":h.name,oninput:()=>i.send("joint",{name:h.name,value:+_.value})});return _.hidden=h.axes.length!==1||f[0]>=f[1],{joint:h,index:u,slider:_,value:p,row:U("label",{title:h.name},U("span",{},h.name.split("::").at(-1)),p,_)}},a=new Set,l=()=>i.connection.want("joints",n.length&&e.open&&!e.hidden||a.size?{}:null);i.wantJoints=(h,u)=>{u?a.add(h):a.delete(h),l()};let c=()=>{let h=i.jointPositions;if(h.length===i.scene?.joints.length)for(let{joint:u,index:f,slider:p,value:_}of n)_.textContent=r(u,h[f]),(document.activeElement!==p||!p.matches(":active"))&&(p.value=h[f])};i.on("scene",h=>{let u=new Set(i.robots.map(_=>_.name)),f=h.jointGroups.filter(([,_])=>u.has(h.joints[_[0]].name.split("::",1)[0]));n=[],t.replaceChildren(...f.flatMap(([_,m])=>{let g=m.slice(0,UE-n.length).map(y=>o(h.joints[y],y));return n.push(...g),g.length?[...f.length>1?[U("h4",{},_)]:[],...g.map(({row:y})=>y)]:[]}));let p=f.flatMap(([,_])=>_).length-n.length;p&&t.append(U("p",{class:"dim"},`and ${p} more`)),e.hidden=n.length===0||h.recording,i.state&&d(i.state),c(),l()}),i.on("packet:joints",({arrays:h})=>{i.jointPositions=h.position,c()});let d=h=>{for(let{slider:u}of n)u.disabled=!h.paused};return i.on("state",d),e.addEventListener("toggle",l),e.hidden=!0,e}var Ax={type:"change"},xp={type:"start"},Rx={type:"end"},Iu=new Ns,Cx=new En,FE=Math.cos(70*pl.DEG2RAD),Dn=new R,yi=2*Math.PI,Pe={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},_p=1e-6,Lu=class extends Pr{constructor(t,e=null){super(t,e),this.state=Pe.NONE,this.target=new R,this.cursor=new R,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:hr.ROTATE,MIDDLE:hr.DOLLY,RIGHT:hr.PAN},this.touches={ONE:ur.ROTATE,TWO:ur.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle="auto",this._domElementKeyEvents=null,this._lastPosition=new R,this._lastQuaternion=new ze,this._lastTargetPosition=new R,this._quat=new ze().setFromUnitVectors(t.up,new R(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new zo,this._sphericalDelta=new zo,this._scale=1,this._panOffset=new R,this._rotateStart=new Bt,this._rotateEnd=new Bt,this._rotateDelta=new Bt,this._panStart=new Bt,this._panEnd=new Bt,this._panDelta=new Bt,this._dollyStart=new Bt,this._dollyEnd=new Bt,this._dollyDelta=new Bt,this._dollyDirection=new R,this._mouse=new Bt,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=kE.bind(this),this._onPointerDown=BE.bind(this),this._onPointerUp=zE.bind(this),this._onContextMenu=qE.bind(this),this._onMouseWheel=HE.bind(this),this._onKeyDown=WE.bind(this),this._onTouchStart=XE.bind(this),this._onTouchMove=YE.bind(this),this._onMouseDown=VE.bind(this),this._onMouseMove=GE.bind(this),this._interceptControlDown=$E.bind(this),this._interceptControlUp=ZE.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(t){this._cursorStyle=t,t==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this._cursorStyle}connect(t){super.connect(t),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=Pe.NONE,this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(t){t.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=t}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(Ax),this.update(),this.state=Pe.NONE}pan(t,e){this._pan(t,e),this.update()}dollyIn(t){this._dollyIn(t),this.update()}dollyOut(t){this._dollyOut(t),this.update()}rotateLeft(t){this._rotateLeft(t),this.update()}rotateUp(t){this._rotateUp(t),this.update()}update(t=null){let e=this.object.position;Dn.copy(e).sub(this.target),Dn.applyQuaternion(this._quat),this._spherical.setFromVector3(Dn),this.autoRotate&&this.state===Pe.NONE&&this._rotateLeft(this._getAutoRotationAngle(t)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(n)&&isFinite(s)&&(n<-Math.PI?n+=yi:n>Math.PI&&(n-=yi),s<-Math.PI?s+=yi:s>Math.PI&&(s-=yi),n<=s?this._spherical.theta=Math.max(n,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+s)/2?Math.max(n,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let o=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=o!=this._spherical.radius}if(Dn.setFromSpherical(this._spherical),Dn.applyQuaternion(this._quatInverse),e.copy(this.target).add(Dn),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let o=null;if(this.object.isPerspectiveCamera){let a=Dn.length();o=this._clampDistance(a*this._scale);let l=a-o;this.object.position.addScaledVector(this._dollyDirection,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){let a=new R(this._mouse.x,this._mouse.y,0);a.unproject(this.object);let l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;let c=new R(this._mouse.x,this._mouse.y,0);c.unproject(this.object),this.object.position.sub(c).add(a),this.object.updateMatrixWorld(),o=Dn.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;o!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(o).add(this.object.position):(Iu.origin.copy(this.object.position),Iu.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(Iu.direction))<FE?this.object.lookAt(this.target):(Cx.setFromNormalAndCoplanarPoint(this.object.up,this.target),Iu.intersectPlane(Cx,this.target))))}else if(this.object.isOrthographicCamera){let o=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),o!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>_p||8*(1-this._lastQuaternion.dot(this.object.quaternion))>_p||this._lastTargetPosition.distanceToSquared(this.target)>_p?(this.dispatchEvent(Ax),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(t){return t!==null?yi/60*this.autoRotateSpeed*t:yi/60/60*this.autoRotateSpeed}_getZoomScale(t){let e=Math.abs(t*.01);return Math.pow(.95,this.zoomSpeed*e)}_rotateLeft(t){this._sphericalDelta.theta-=t}_rotateUp(t){this._sphericalDelta.phi-=t}_panLeft(t,e){Dn.setFromMatrixColumn(e,0),Dn.multiplyScalar(-t),this._panOffset.add(Dn)}_panUp(t,e){this.screenSpacePanning===!0?Dn.setFromMatrixColumn(e,1):(Dn.setFromMatrixColumn(e,0),Dn.crossVectors(this.object.up,Dn)),Dn.multiplyScalar(t),this._panOffset.add(Dn)}_pan(t,e){let n=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;Dn.copy(s).sub(this.target);let r=Dn.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*t*r/n.clientHeight,this.object.matrix),this._panUp(2*e*r/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(t*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(e*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(t){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=t:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(t){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=t:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(t,e){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let n=this.domElement.getBoundingClientRect(),s=t-n.left,r=e-n.top,o=n.width,a=n.height;this._mouse.x=s/o*2-1,this._mouse.y=-(r/a)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(t){return Math.max(this.minDistance,Math.min(this.maxDistance,t))}_handleMouseDownRotate(t){this._rotateStart.set(t.clientX,t.clientY)}_handleMouseDownDolly(t){this._updateZoomParameters(t.clientX,t.clientY),this._dollyStart.set(t.clientX,t.clientY)}_handleMouseDownPan(t){this._panStart.set(t.clientX,t.clientY)}_handleMouseMoveRotate(t){this._rotateEnd.set(t.clientX,t.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let e=this.domElement;this._rotateLeft(yi*this._rotateDelta.x/e.clientHeight),this._rotateUp(yi*this._rotateDelta.y/e.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(t){this._dollyEnd.set(t.clientX,t.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(t){this._panEnd.set(t.clientX,t.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(t){this._updateZoomParameters(t.clientX,t.clientY),t.deltaY<0?this._dollyIn(this._getZoomScale(t.deltaY)):t.deltaY>0&&this._dollyOut(this._getZoomScale(t.deltaY)),this.update()}_handleKeyDown(t){let e=!1;switch(t.code){case this.keys.UP:t.ctrlKey||t.metaKey||t.shiftKey?this.enableRotate&&this._rotateUp(yi*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),e=!0;break;case this.keys.BOTTOM:t.ctrlKey||t.metaKey||t.shiftKey?this.enableRotate&&this._rotateUp(-yi*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),e=!0;break;case this.keys.LEFT:t.ctrlKey||t.metaKey||t.shiftKey?this.enableRotate&&this._rotateLeft(yi*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),e=!0;break;case this.keys.RIGHT:t.ctrlKey||t.metaKey||t.shiftKey?this.enableRotate&&this._rotateLeft(-yi*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),e=!0;break}e&&(t.preventDefault(),this.update())}_handleTouchStartRotate(t){if(this._pointers.length===1)this._rotateStart.set(t.pageX,t.pageY);else{let e=this._getSecondPointerPosition(t),n=.5*(t.pageX+e.x),s=.5*(t.pageY+e.y);this._rotateStart.set(n,s)}}_handleTouchStartPan(t){if(this._pointers.length===1)this._panStart.set(t.pageX,t.pageY);else{let e=this._getSecondPointerPosition(t),n=.5*(t.pageX+e.x),s=.5*(t.pageY+e.y);this._panStart.set(n,s)}}_handleTouchStartDolly(t){let e=this._getSecondPointerPosition(t),n=t.pageX-e.x,s=t.pageY-e.y,r=Math.sqrt(n*n+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(t){this.enableZoom&&this._handleTouchStartDolly(t),this.enablePan&&this._handleTouchStartPan(t)}_handleTouchStartDollyRotate(t){this.enableZoom&&this._handleTouchStartDolly(t),this.enableRotate&&this._handleTouchStartRotate(t)}_handleTouchMoveRotate(t){if(this._pointers.length==1)this._rotateEnd.set(t.pageX,t.pageY);else{let n=this._getSecondPointerPosition(t),s=.5*(t.pageX+n.x),r=.5*(t.pageY+n.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let e=this.domElement;this._rotateLeft(yi*this._rotateDelta.x/e.clientHeight),this._rotateUp(yi*this._rotateDelta.y/e.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(t){if(this._pointers.length===1)this._panEnd.set(t.pageX,t.pageY);else{let e=this._getSecondPointerPosition(t),n=.5*(t.pageX+e.x),s=.5*(t.pageY+e.y);this._panEnd.set(n,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(t){let e=this._getSecondPointerPosition(t),n=t.pageX-e.x,s=t.pageY-e.y,r=Math.sqrt(n*n+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let o=(t.pageX+e.x)*.5,a=(t.pageY+e.y)*.5;this._updateZoomParameters(o,a)}_handleTouchMoveDollyPan(t){this.enableZoom&&this._handleTouchMoveDolly(t),this.enablePan&&this._handleTouchMovePan(t)}_handleTouchMoveDollyRotate(t){this.enableZoom&&this._handleTouchMoveDolly(t),this.enableRotate&&this._handleTouchMoveRotate(t)}_addPointer(t){this._pointers.push(t.pointerId)}_removePointer(t){delete this._pointerPositions[t.pointerId];for(let e=0;e<this._pointers.length;e++)if(this._pointers[e]==t.pointerId){this._pointers.splice(e,1);return}}_isTrackingPointer(t){for(let e=0;e<this._pointers.length;e++)if(this._pointers[e]==t.pointerId)return!0;return!1}_trackPointer(t){let e=this._pointerPositions[t.pointerId];e===void 0&&(e=new Bt,this._pointerPositions[t.pointerId]=e),e.set(t.pageX,t.pageY)}_getSecondPointerPosition(t){let e=t.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[e]}_customWheelEvent(t){let e=t.deltaMode,n={clientX:t.clientX,clientY:t.clientY,deltaY:t.deltaY};switch(e){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100;break}return t.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}};function BE(i){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(i.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(i)&&(this._addPointer(i),i.pointerType==="touch"?this._onTouchStart(i):this._onMouseDown(i),this._cursorStyle==="grab"&&(this.domElement.style.cursor="grabbing")))}function kE(i){this.enabled!==!1&&(i.pointerType==="touch"?this._onTouchMove(i):this._onMouseMove(i))}function zE(i){switch(this._removePointer(i),this._pointers.length){case 0:this.domElement.releasePointerCapture(i.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(Rx),this.state=Pe.NONE,this._cursorStyle==="grab"&&(this.domElement.style.cursor="grab");break;case 1:let t=this._pointers[0],e=this._pointerPositions[t];this._onTouchStart({pointerId:t,pageX:e.x,pageY:e.y});break}}function VE(i){let t;switch(i.button){case 0:t=this.mouseButtons.LEFT;break;case 1:t=this.mouseButtons.MIDDLE;break;case 2:t=this.mouseButtons.RIGHT;break;default:t=-1}switch(t){case hr.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(i),this.state=Pe.DOLLY;break;case hr.ROTATE:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=Pe.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=Pe.ROTATE}break;case hr.PAN:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=Pe.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=Pe.PAN}break;default:this.state=Pe.NONE}this.state!==Pe.NONE&&this.dispatchEvent(xp)}function GE(i){switch(this.state){case Pe.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(i);break;case Pe.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(i);break;case Pe.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(i);break}}function HE(i){this.enabled===!1||this.enableZoom===!1||this.state!==Pe.NONE||(i.preventDefault(),this.dispatchEvent(xp),this._handleMouseWheel(this._customWheelEvent(i)),this.dispatchEvent(Rx))}function WE(i){this.enabled!==!1&&this._handleKeyDown(i)}function XE(i){switch(this._trackPointer(i),this._pointers.length){case 1:switch(this.touches.ONE){case ur.ROTATE:if(this.enableRotate===!1){this.state=Pe.NONE;break}this._handleTouchStartRotate(i),this.state=Pe.TOUCH_ROTATE;break;case ur.PAN:if(this.enablePan===!1){this.state=Pe.NONE;break}this._handleTouchStartPan(i),this.state=Pe.TOUCH_PAN;break;default:this.state=Pe.NONE}break;case 2:switch(this.touches.TWO){case ur.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(i),this.state=Pe.TOUCH_DOLLY_PAN;break;case ur.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(i),this.state=Pe.TOUCH_DOLLY_ROTATE;break;default:this.state=Pe.NONE}break;default:this.state=Pe.NONE}this.state!==Pe.NONE&&this.dispatchEvent(xp)}function YE(i){switch(this._trackPointer(i),this.state){case Pe.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(i),this.update();break;case Pe.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(i),this.update();break;case Pe.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(i),this.update();break;case Pe.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(i),this.update();break;default:this.state=Pe.NONE}}function qE(i){this.enabled!==!1&&i.preventDefault()}function $E(i){i.key==="Control"&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function ZE(i){i.key==="Control"&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}Ee.DEFAULT_UP.set(0,0,1);var JE=/swiftshader|llvmpipe|software|basic render/i,Px=300,jE=1e3,KE=.75,QE=4,yp={auto:"automatic",full:"full",fast:"fast"},Du=class{constructor(t,e){this.canvas=t;let n=document.createElement("canvas").getContext("webgl2");if(!n)throw new Error("This browser has no WebGL 2, which the scene needs.");let s=n.getExtension("WEBGL_debug_renderer_info");this.renderer=s?n.getParameter(s.UNMASKED_RENDERER_WEBGL):"",this.isSoftware=JE.test(this.renderer),n.getExtension("WEBGL_lose_context")?.loseContext();let r=new Bh({canvas:t,antialias:!1});r.shadowMap.enabled=!0,r.shadowMap.type=Ir,this.gl=r,this.quality=Object.hasOwn(yp,e)?e:"auto",this.isFull=null,this.onQuality=[],this.movedAt=this.fullAt=-1e6,this.makeCopy(),this.scene=new Fa,this.camera=new An(45,1,.02,500),this.camera.position.set(-4,-4,3),this.controls=new Lu(this.camera,t),this.controls.enableDamping=!0,this.controls.dampingFactor=.2,this.controls.zoomToCursor=!0,this.controls.addEventListener("change",()=>this.move()),this.lights=new Cn,this.helpers=new Cn,this.scene.add(this.lights,this.helpers),this.makeSky(),this.limit=()=>{},this.before=[],this.after=[],this.cuts=[],this.draws=this.triangles=0,this.extent=5,this.dirty=!1,this.shadows=!0,new ResizeObserver(()=>this.resize()).observe(t.parentElement),this.resize()}resize(){let{clientWidth:t,clientHeight:e}=this.canvas.parentElement;!t||!e||(this.gl.setSize(t,e,!1),this.camera.aspect=t/e,this.camera.updateProjectionMatrix(),this.fitted?.at.distanceTo(this.camera.position)<1e-6&&this.fit(...this.fitted.arguments),this.move())}move(){this.movedAt=performance.now(),this.waits&&(clearTimeout(this.waits),this.waits=null,this.dirty=!1),this.invalidate()}invalidate(){if(this.dirty)return;this.dirty=!0;let t=()=>{this.waits=null,requestAnimationFrame(()=>this.draw())},e=this.isSoftware&&this.isFull&&this.wantsFull()?this.fullAt+jE-performance.now():0;e>0?this.waits=setTimeout(t,e):t()}setQuality(t){this.quality=t,this.move()}wantsFull(){return this.quality!=="auto"?this.quality==="full":!this.isSoftware||performance.now()-this.movedAt>=Px}chooseQuality(){let t=this.wantsFull();if(clearTimeout(this.rest),!t&&this.quality==="auto"&&(this.rest=setTimeout(()=>this.invalidate(),Px+10)),t&&(this.fullAt=performance.now()),t!==this.isFull){this.isFull=t,this.gl.setPixelRatio(t?Math.min(devicePixelRatio,2):KE),this.showShadows();for(let e of this.onQuality)e(t)}}makeCopy(){this.target=new Xn(1,1,{colorSpace:Te,samples:QE});let t=new ui({depthTest:!1,depthWrite:!1,uniforms:{picture:{value:this.target.texture}},vertexShader:"varying vec2 place;void main(){place=uv;gl_Position=vec4(position.xy,0.,1.);}",fragmentShader:`uniform sampler2D picture;varying vec2 place;
        void main(){gl_FragColor=texture2D(picture,place);
        #include <colorspace_fragment>
        }`});this.copy=new St(new gi(2,2),t),this.copy.frustumCulled=!1}draw(){this.dirty=!1,this.chooseQuality(),this.limit(),this.controls.update();for(let e of this.before)e();let t=this.camera.position.distanceTo(this.controls.target);if(this.camera.near=Math.max(.004,.01*t),this.camera.far=Math.max(300,12*t,6*this.extent),this.camera.updateProjectionMatrix(),this.placeSun(t),this.sky.position.copy(this.camera.position),this.sky.scale.setScalar(.9*this.camera.far),this.gl.clippingPlanes=this.cuts,this.isFull){let{width:e,height:n}=this.canvas;(this.target.width!==e||this.target.height!==n)&&this.target.setSize(e,n),this.gl.setRenderTarget(this.target)}this.gl.render(this.scene,this.camera),this.triangles=this.gl.info.render.triangles,this.gl.clippingPlanes=[],this.isFull&&(this.gl.setRenderTarget(null),this.gl.render(this.copy,this.camera)),this.draws+=1;for(let e of this.after)e()}makeSky(){this.skyColours={top:{value:new Xt},horizon:{value:new Xt}};let t=new ui({side:Yn,depthWrite:!1,fog:!1,uniforms:this.skyColours,vertexShader:"varying vec3 ray;void main(){ray=position;gl_Position=projectionMatrix*modelViewMatrix*vec4(position,1.);}",fragmentShader:`uniform vec3 top,horizon;varying vec3 ray;
        void main(){float h=normalize(ray).z;gl_FragColor=vec4(mix(horizon,top,smoothstep(0.,.6,h)),1.);
        #include <colorspace_fragment>
        }`});this.sky=new St(new hi(1,24,16),t),this.sky.frustumCulled=!1,this.sky.renderOrder=-1,this.scene.add(this.sky)}setSurroundings(t,e){this.around=t;let n=new Xt().setRGB(...t.background,Te),s=n.clone().lerp(new Xt(15922680),.45),r=t.sky?new Xt(6001622):n.clone().lerp(new Xt(7315416),.55);this.skyColours.top.value.copy(r),this.skyColours.horizon.value.copy(s);let o=t.fog;if(o&&Array.isArray(o.colour??o.color)){let a=new Xt().setRGB(...(o.colour??o.color).slice(0,3),Te);this.scene.fog=o.end>0?new No(a,o.start??0,o.end):new Ua(a,o.density??.01),this.skyColours.horizon.value.copy(a)}else this.scene.fog=new No(s,Math.max(40,4*t.extent),Math.max(220,14*t.extent));this.lightArrays=e,this.makeLights()}makeLights(){let{around:t,lightArrays:e,lights:n}=this;for(let c of[...n.children])n.remove(c),c.dispose?.();let s=Math.max(...t.ambient,.12),r=c=>Math.min(c,1.05)**1.8,o=new ja(16777215,13617341,Math.PI*.92*r(s));n.add(o),this.sun=null;let a=0,l=0;t.lights.forEach((c,d)=>{if(!e.light_active[d]||l>=12)return;let h=e.light_diffuse.slice(3*d,3*d+3),u=Math.max(...h);if(!(u>0))return;l+=1;let f=new Xt().setRGB(h[0]/u,h[1]/u,h[2]/u,Te),p=new R().fromArray(e.light_pos,3*d),_=new R().fromArray(e.light_dir,3*d).normalize(),m=Math.PI*Math.max(.15,r(s+u)-r(s)),g;if(c.kind==="directional")g=new Bo(f,m),g.userData.direction=_;else{let[y,T,v]=c.attenuation,M=3,b=m*M**2/Math.max(.05,y+T*M+v*M*M),x=T||v?2:0;g=c.kind==="spot"?new Qa(f,x?b:m,0,Math.min(c.cutoff*Math.PI/180,1.5),.4,x):new tl(f,x?b:m,0,x),g.position.copy(p),g.target&&g.target.position.copy(p).add(_)}c.shadow&&t.shadows&&c.kind!=="point"&&a<2&&(g.userData.hasShadow=!0,g.shadow.mapSize.set(2048,2048),g.shadow.bias=-3e-4,g.shadow.normalBias=.012,g.shadow.radius=2.5,a+=1),c.kind==="directional"&&!this.sun&&(this.sun=g),n.add(g),g.target&&n.add(g.target)}),l===0&&(this.sun=new Bo(16777215,2.2),this.sun.userData.direction=new R(.45,.6,-.9).normalize(),this.sun.userData.hasShadow=!0,this.sun.shadow.mapSize.set(2048,2048),this.sun.shadow.normalBias=.004,n.add(this.sun,this.sun.target)),this.showShadows(),this.invalidate()}showShadows(){for(let t of this.lights.children)t.castShadow=!!t.userData.hasShadow&&this.shadows&&this.isFull===!0}placeSun(t){for(let e of this.lights.children){let n=e.userData.direction;if(!n)continue;let s=Math.min(Math.max(.9*t,1.5),40,1.5*this.extent+2);e.target.position.copy(this.controls.target),e.position.copy(this.controls.target).addScaledVector(n,-3*s),e.castShadow&&(Object.assign(e.shadow.camera,{left:-s,right:s,top:s,bottom:-s,near:.1,far:7*s}),e.shadow.camera.updateProjectionMatrix())}}fit(t,e,n=.94){let s=t.getCenter(new R),r=e.clone().normalize(),o=this.fitDistance(t,r,n);this.controls.target.copy(s),this.camera.position.copy(s).addScaledVector(r,-o),this.controls.update(),this.fitted={at:this.camera.position.clone(),arguments:[t,e,n]},this.invalidate()}fitDistance(t,e,n){let s=t.getCenter(new R),r=new R().crossVectors(e,new R(0,0,1));r.lengthSq()<1e-9&&r.set(1,0,0),r.normalize();let o=new R().crossVectors(r,e),a=Math.tan(this.camera.fov*Math.PI/360)*n,l=a*this.camera.aspect,c=.2;for(let d=0;d<8;d++){let h=new R(d&1?t.max.x:t.min.x,d&2?t.max.y:t.min.y,d&4?t.max.z:t.min.z).sub(s);c=Math.max(c,Math.abs(h.dot(r))/l-h.dot(e),Math.abs(h.dot(o))/a-h.dot(e))}return c}};function Ix(i){let t=bf.map(([r,o,a])=>Jo(`show-${r}`,o,a,l=>i.layers.set(r,l))),e=U("select",{id:"quality",title:"Automatic: full while nothing moves, and fast while something moves on a computer without a graphics card",onchange:()=>{i.stage.setQuality(e.value),jh("quality",e.value)}},...Object.entries(yp).map(([r,o])=>U("option",{value:r,selected:r===i.stage.quality},o))),n=U("span",{id:"quality-now",class:"dim"});i.stage.onQuality.push(r=>{n.textContent=i.stage.quality==="auto"?`now ${r?"full":"fast"}`:""}),e.addEventListener("change",()=>{n.textContent=""});let s=U("label",{class:"check",style:"margin-top: 8px"},"Drawing",e,n);return ni("layers","Show",U("div",{class:"checks"},...t),s)}var tA=60;function Lx(i){let t=U("select",{id:"spawn-model",title:"Model to spawn"}),e=U("button",{id:"spawn",title:"Click on the ground where the model shall stand",onclick:()=>m(!i.clickMode)},"Place"),n=U("div",{class:"dim",id:"edited"}),s=(x,w,O,P)=>U("button",{id:x,title:O,onclick:P},w),r=U("div",{class:"row"},s("move-model","Move","Move the selected model along the arrows",()=>T("translate")),s("turn-model","Turn","Turn the selected model by the rings",()=>T("rotate")),s("delete-model","Delete","Remove the selected model from the world",()=>b())),o=ni("models","Models",U("div",{class:"row"},t,e),n,r),a=new Ee,l=new la(i.stage.camera,i.stage.canvas),c=l.getHelper();i.stage.helpers.add(a,c),l.setSize(.8);let d={},h=null,u=null,f=null,p=()=>i.selected?.split("::",1)[0]??null,_=()=>{let x=i.clickMode===g;n.textContent=x?"click on the ground":p()??"select a model to move, turn or delete it";for(let w of r.children)w.disabled=p()===null;r.children[0].classList.toggle("on",h!==null&&l.mode==="translate"),r.children[1].classList.toggle("on",h!==null&&l.mode==="rotate"),e.classList.toggle("on",x)},m=x=>{v(),i.clickMode=x?g:null,i.stage.canvas.style.cursor=x?"crosshair":"",_()},g=async(x,w)=>{let O=x?.point??i.groundAt(w);if(!O)return;m(!1);let P=d[t.value],L=t.value,B=1;for(;i.models.has(L);)L=`${t.value}_${B++}`;try{f=await i.ask("spawn",{source:P,name:L,x:O.x,y:O.y}),y()}catch(G){i.report(G.message)}},y=()=>{i.models.has(f)&&(i.select(i.models.get(f).links[0]??f),f=null)},T=async x=>{let w=p(),O=h===w&&l.mode===x;if(v(),!(O||w===null)){try{on(await i.ask("model_pose",{name:w}),0,a.matrix)}catch(P){i.report(P.message);return}a.matrix.decompose(a.position,a.quaternion,a.scale),i.markerHandles?.end(),h=w,l.setMode(x),l.attach(a),i.clickMode=P=>{l.axis||(v(),i.select(P&&!P.isFloor?P.link:null))},_(),i.stage.invalidate()}},v=()=>{h=null,i.clickMode=null,l.detach(),_(),i.stage.invalidate()},M=()=>{u=null;let{x,y:w,z:O,w:P}=a.quaternion;h&&i.send("move",{name:h,position:a.position.toArray(),quaternion:[P,x,w,O]})};l.addEventListener("objectChange",()=>{u??=setTimeout(M,tA)}),l.addEventListener("change",()=>i.stage.invalidate()),l.addEventListener("dragging-changed",({value:x})=>{i.stage.controls.enabled=!x&&i.views.sensor===null,x||(clearTimeout(u),M())});let b=()=>{let x=p();v(),i.send("remove",{name:x}).then(()=>i.select(null))};return addEventListener("keydown",x=>{x.key==="Escape"&&i.clickMode&&m(!1)}),i.on("select",()=>{h!==null&&h!==p()&&v(),_()}),i.on("scene",x=>{o.hidden=!!x.recording,!o.hidden&&(i.selected&&!i.models.has(p())&&i.select(null),y(),_())}),i.on("link",x=>{!x||i.player||i.ask("spawnable").then(w=>{d=w,t.replaceChildren(...Object.keys(w).map(O=>U("option",{},O)))}).catch(()=>{})}),i.modelEditor={gizmo:l,proxy:a,end:v,get edited(){return h}},o.hidden=!0,_(),o}var Dx=[[.55,.62,-.56],[-.55,.62,-.56],[.55,-.62,-.56],[-.55,-.62,-.56],[.4,.45,-.9],[.1,.15,-1]],eA=.5,nA=.05,iA=300,sA=20,rA=20,oA=12,aA=400,lA=.3,vp=.1,Nx=.05,cA=[0,.25,.5,.75,1,1.25],hA=1.4,uA=.5,Ou=(i,t)=>i===t||i.startsWith(`${t}::`),Nu=class{constructor(t){this.app=t,this.followed=null,this.sensor=null,this.flight=null,t.stage.before.push(()=>this.update()),t.stage.limit=()=>this.limitOrbit(),t.stage.controls.addEventListener("start",()=>{this.flight=null})}strays(){let{world:t,bodyOf:e}=this.app,n=t.boxesByModel(),s=[...n.keys()],r=new Set;if(s.length<3)return r;let o=(f,p)=>new R().subVectors(f.min,p.max).max(new R().subVectors(p.min,f.max)).max(new R).length(),a=new Map(s.map(f=>[f,n.get(f).getCenter(new R)])),l=f=>[...a.values()].map(p=>p[f]).sort((p,_)=>p-_)[s.length>>1],c=new R(l("x"),l("y"),l("z")),d=f=>{let{x:p,y:_,z:m}=a.get(f).clone().sub(c);return Math.max(Math.abs(p),Math.abs(_),Math.abs(m))},h=s.sort((f,p)=>d(f)-d(p)),u=new en;h.slice(0,Math.ceil(h.length/2)).forEach(f=>u.union(n.get(f)));for(let f of h){let p=u.getSize(new R).length();o(n.get(f),u)>Math.max(iA,sA*p)?r.add(f):!e.has(f)||n.get(f).max.z>=u.min.z-Math.max(rA,2*p)?u.union(n.get(f)):r.add(f)}return r}robotBox(t=this.strays()){let{world:e,robots:n}=this.app,s=new Set(n.map(r=>r.name).filter(r=>!t.has(r)));return e.boxOf(r=>s.has(e.linkOf(r).split("::",1)[0]))}worldBox(t=this.strays()){let{world:e}=this.app;return e.boxOf((n,s)=>!s&&!t.has(e.linkOf(n).split("::",1)[0]))}first(){let{stage:t}=this.app;this.release();let e=this.strays(),n=this.worldBox(e),s=this.robotBox(e),r=n.isEmpty()?new en(new R(-2,-2,0),new R(2,2,1)):n;if(!(n.isEmpty()||s.isEmpty()||n.getSize(new R).length()<oA)&&this.app.hasRobots){r=s.clone();let c=r.getSize(new R),d=Math.max(.35*c.length(),1.2);r.min.x-=d,r.min.y-=d,r.max.x+=d,r.max.y+=d}let a=e.size?[`outside of the view: ${[...e].slice(0,3).join(", ")}${e.size>3?` and ${e.size-3} more`:""}`]:[],l=new R(...Dx[0]);if(t.triangles<4e5){let c=s.isEmpty()?this.roomPoints(e):this.robotPoints(s),d=this.clearest(r,c,1/0);if(d.share<eA&&!n.isEmpty()){let h=s.isEmpty()?(n.min.z+n.max.z)/2:s.max.z+nA,u=this.clearest(r,c,h);u.share>d.share&&(d=u,t.cuts=[new En(new R(0,0,-1),h)],a.push(`opened above z = ${h.toPrecision(3)} m`))}d.direction&&(l=d.direction)}t.fit(r,l),a.length&&this.app.report(a.join("; "))}robotPoints(t){let{min:e,max:n}=t,s=new Set(this.app.robots.map(o=>o.name)),r=[t.getCenter(new R)];for(let o of[e.x,n.x])for(let a of[e.y,n.y])r.push(new R(o,a,.7*e.z+.3*n.z));return r.map(o=>({point:o,own:s}))}roomPoints(t){let e=[...this.app.world.boxesByModel()].filter(([r])=>!t.has(r)).map(([r,o])=>({point:o.getCenter(new R),own:new Set([r]),size:o.getSize(new R).length()})).sort((r,o)=>r.size-o.size),n=e.slice(0,Math.ceil(e.length/2)),s=Math.ceil(n.length/12);return n.filter((r,o)=>o%s===0)}clearest(t,e,n){let{stage:s,world:r}=this.app,o=new di,a=null,l=-1;for(let c of Dx){let d=new R(...c).normalize(),h=t.getCenter(new R).addScaledVector(d,-s.fitDistance(t,d,.94)),u=e.filter(({point:f,own:p})=>{let _=h.clone();_.z>n&&f.z<n&&_.lerp(f,(_.z-n)/(_.z-f.z)),o.set(_,f.clone().sub(_).normalize()),o.camera=s.camera;let m=r.pick(o);return!m||p.has(m.link.split("::",1)[0])||m.point.distanceTo(_)>f.distanceTo(_)}).length;if(u>l&&(l=u,a=d),u===e.length)break}return{direction:a,share:e.length?l/e.length:1}}all(){this.release();let t=this.worldBox();t.isEmpty()||this.app.stage.fit(t,this.app.stage.controls.target.clone().sub(this.app.stage.camera.position))}top(){this.release();let t=this.worldBox();t.isEmpty()||this.app.stage.fit(t,new R(0,.001,-1))}follow(t){let{stage:e,world:n,scene:s}=this.app;if(this.detach(),this.followed=t,t!==null){this.own=s.frames.find(([,c])=>c===t)[0].split("::",1)[0],n.place();let r=n.boxOf(c=>n.modelOf(c)===this.own),o=new R().setFromMatrixPosition(n.bodies[t]);this.last=o,e.controls.target.copy(o),r.isEmpty()||(e.controls.target.z=Math.max(o.z,(r.min.z+r.max.z)/2)),this.least=Math.max(.5,1.2*(r.isEmpty()?0:r.getSize(new R).length()));let a=e.camera.position.clone().sub(e.controls.target),l=Math.min(a.length(),3.5);a.normalize(),a.z=Math.max(a.z,.35),this.wanted=a.setLength(Math.max(l,this.least)),this.taken=null}this.app.emit("view"),e.move()}clearOffset(t,e,n,s){let r=e.length(),o=Math.hypot(e.x,e.y),a=Math.atan2(e.z,o),l=e,c=-1;for(let d of cA){let h=d?Math.max(a,Math.min(a+d,hA)):a,u=o>1e-6?r*Math.cos(h)/o:0,f=new R(e.x*u,e.y*u,r*Math.sin(h)).normalize(),p=this.app.world.sight(t,f,r+vp,n)-vp;if(p>c&&(c=p,l=f.multiplyScalar(Math.max(p,vp))),p>=Math.min(s,r)-1e-6)break}return l}keepFollowing(){let{stage:{camera:t,controls:e},world:n}=this.app,s=new R().setFromMatrixPosition(n.bodies[this.followed]),r=s.clone().sub(this.last);this.last=s,e.target.add(r);let o=t.position.clone().add(r).sub(e.target);this.taken&&o.distanceTo(this.taken)>1e-4&&(this.wanted=o.multiplyScalar(this.wanted.length()/this.taken.length())),this.taken=this.clearOffset(e.target,this.wanted,this.own,this.least),t.position.copy(e.target).add(this.taken),t.lookAt(e.target)}floorAt(t){let{stage:{controls:e},world:n,scene:s}=this.app;return s&&!this.sensor?n.floorAt(t,e.target.z+uA):null}limitOrbit(){let{camera:t,controls:e}=this.app.stage,n=this.floorAt(t.position),s=n===null?-1:(n+Nx-e.target.z)/t.position.distanceTo(e.target);e.maxPolarAngle=Math.acos(Math.min(Math.max(s,-1),1))}liftAboveFloor(){let{camera:t,controls:e}=this.app.stage,n=this.floorAt(t.position),s=this.floorAt(e.target),r=Math.max(0,n===null?0:n+Nx-t.position.z,s===null?0:s-e.target.z);t.position.z+=r,e.target.z+=r}flyTo(t){let{stage:e,world:n}=this.app,s=t.split("::",1)[0],r=n.boxOf((d,h)=>!h&&Ou(n.linkOf(d),t));if(r.isEmpty())return;this.detach();let{camera:o,controls:a}=e,l=r.getCenter(new R),c=o.position.clone().sub(a.target);c.setLength(Math.max(e.fitDistance(r,c.clone().negate().normalize(),lA),.3)),c.copy(this.clearOffset(l,c,s,.6*c.length())),this.flight={begin:performance.now(),eye:[o.position.clone(),l.clone().add(c)],target:[a.target.clone(),l]},e.move()}fly(){let{stage:t}=this.app,{begin:e,eye:n,target:s}=this.flight,r=Math.min(1,(performance.now()-e)/aA),o=r*r*(3-2*r);t.camera.position.lerpVectors(...n,o),t.controls.target.lerpVectors(...s,o),t.camera.lookAt(t.controls.target),r===1&&(this.flight=null),t.move()}through(t){this.detach(),this.sensor=t,this.app.stage.cuts=[],this.app.stage.controls.enabled=!1,this.app.emit("view"),this.app.stage.invalidate()}detach(){this.followed=this.sensor=this.flight=null,this.app.stage.controls.enabled=!0,this.app.stage.camera.fov=45,this.app.stage.camera.up.set(0,0,1),this.app.emit("view")}release(){this.app.stage.cuts=[],this.detach()}update(){let{stage:t}=this.app;this.followed!==null&&this.keepFollowing(),this.flight&&this.fly(),this.liftAboveFloor(),this.sensor?(this.aim(t.camera,this.sensor,t.camera.aspect),t.controls.target.copy(t.camera.position).add(new R(0,0,-1).applyQuaternion(t.camera.quaternion))):t.camera.up.set(0,0,1)}aim(t,e,n){let s=this.app.sensors.poseOf(e),r=new R,o=new R,a=new R;s.extractBasis(r,o,a),t.position.setFromMatrixPosition(s);let l=new Wt().makeBasis(o.clone().negate(),a,r.clone().negate());t.quaternion.setFromRotationMatrix(l);let{width:c,height:d,hfov:h}=e.camera,u=Math.tan(Math.min(h,2.6)/2);t.fov=2*Math.atan(Math.max(u*d/c,u/n*(n<c/d?1:0)))*180/Math.PI,t.updateProjectionMatrix()}};function Ox(i){let t=U("div",{class:"selection"}),e=U("button",{onclick:()=>i.views.follow(r)},"Follow"),n=ni("selection","Selected",t,e),s=new sl(new en,16765502);Object.assign(s.material,{depthTest:!1,transparent:!0,fog:!1}),s.renderOrder=6,s.visible=!1,i.stage.helpers.add(s);let r=null,o=()=>{if(n.hidden=i.selected===null,s.visible=i.selected!==null,i.selected===null)return;let a=i.scene.frames.find(([c])=>Ou(c,i.selected));r=a?a[1]:i.scene.bodies.indexOf(i.selected),e.hidden=!(r>0);let l=[i.selected];if(a&&a[0]!==i.selected&&l.push(`pose of ${a[0].slice(i.selected.length+2)}`),r>0){let c=i.world.bodies[r],d=new R().setFromMatrixPosition(c),h=new Qn().setFromRotationMatrix(c,"ZYX"),u=f=>_s(f*180/Math.PI,1);l.push(`x ${_s(d.x,3)}  y ${_s(d.y,3)}  z ${_s(d.z,3)} m`),l.push(`roll ${u(h.x)}  pitch ${u(h.y)}  yaw ${u(h.z)}\xB0`)}else l.push("static");t.replaceChildren(...l.map(c=>U("div",{},c)))};return i.on("select",o),i.on("state",()=>{i.selected!==null&&o()}),i.stage.before.push(()=>{i.selected!==null&&s.box.copy(i.world.boxOf(a=>Ou(i.world.linkOf(a),i.selected)))}),n.hidden=!0,n}function Ux(i){let t=U("div",{class:"tree"}),e=r=>r.split("::").at(-1),n=r=>U("button",{class:"leaf",title:r,"data-link":r,onclick:()=>i.select(r)},e(r)),s=r=>{let o=U("button",{class:"model","data-model":r.scoped,onclick:l=>{l.preventDefault(),a.open=!0,i.select(r.scoped),i.views.flyTo(r.scoped)}},r.name),a=U("details",{class:r.static?"static":""},U("summary",{title:r.scoped},o));return a.addEventListener("toggle",()=>{a.open&&a.childElementCount===1&&a.append(...r.links.map(n),...r.models.map(s))}),a};return i.on("scene",r=>t.replaceChildren(...r.models.map(s))),i.on("select",r=>{for(let o of t.querySelectorAll(".leaf, .model"))o.classList.toggle("selected",(o.dataset.link??o.dataset.model)===r)}),ni("tree","World",t)}var Fx=[["left",Ux],["left",Ox],["left",Lx],["right",Ix],["right",wx],["right",M0],["right",Tx],["right",Ex],["right",gx]];var dA=.005,Uu=class{constructor(t,e){this.app=t,this.recording=e;let{times:n}=e.arrays;this.times=n,this.length=n[n.length-1],this.size=e.arrays.poses.length/n.length,this.time=0,this.pace=1,this.isPlaying=!1,this.bar=U("input",{type:"range",id:"seek",min:0,max:this.length,step:.01,value:0,"aria-label":"Time",oninput:()=>this.seek(+this.bar.value)}),document.getElementById("view").append(this.bar)}async ask(t,{value:e,count:n}={}){if(t==="pause")this.setPlaying(!e);else if(t==="step")this.setPlaying(!1),this.seek(this.time+n/15);else if(t==="reset")this.seek(0);else if(t==="pace")this.pace=e??5,this.show();else{if(t==="travel")return this.paths(this.time);throw new Error("a recording cannot do this")}return null}setPlaying(t){this.isPlaying=t&&this.length>0,this.isPlaying&&this.time>=this.length&&(this.time=0),this.last=performance.now(),this.isPlaying&&requestAnimationFrame(()=>this.advance()),this.show()}advance(){if(!this.isPlaying)return;let t=performance.now();this.time+=this.pace*Math.min(t-this.last,250)/1e3,this.last=t,this.time>=this.length&&(this.time=this.length,this.isPlaying=!1),this.show(),this.isPlaying&&requestAnimationFrame(()=>this.advance())}seek(t){this.time=Math.min(Math.max(t,0),this.length),this.show(),this.app.layers.setPaths(this.paths(this.time)),this.app.stage.invalidate()}show(){let{times:t,size:e,recording:n}=this,s=t.length,r=Math.min(this.time*(s-1)/(this.length||1),s-1),o=Math.floor(r),a=Math.min(o+1,s-1),l=n.arrays.poses.subarray(o*e,o*e+e),c=n.arrays.poses.subarray(a*e,a*e+e),d=new Float32Array(e),h=r-o;for(let f=0;f<e;f+=7){let p=l[f+3]*c[f+3]+l[f+4]*c[f+4]+l[f+5]*c[f+5]+l[f+6]*c[f+6]<0?-1:1;for(let _=0;_<3;_++)d[f+_]=l[f+_]+h*(c[f+_]-l[f+_]);for(let _=3;_<7;_++)d[f+_]=l[f+_]+h*(p*c[f+_]-l[f+_])}this.bar.value=this.time;let u=n.begin+this.time;this.app.receive({kind:"state",revision:this.app.scene.revision,time:u,tick:Math.round(1e3*this.time),paused:!this.isPlaying,pace:this.pace,rtf:this.pace,contacts:0,arrays:{poses:d}}),this.showScans(),this.showDisplays()}displayTopics(){return(this.recording.displays??[]).map(({topic:t,type:e})=>[t,e])}showDisplays(t=!1){this.drawn??=new Map,(this.recording.displays??[]).forEach(({topic:e,times:n,ends:s},r)=>{if(!this.app.displays.wanted.has(e)){this.drawn.delete(e);return}let o=n.findLastIndex(c=>c<=this.time+1e-6);if(!t&&this.drawn.get(e)===o)return;this.drawn.set(e,o);let a=this.recording.arrays[`display${r}`],l=o<0?{kind:`display:${e}`,problems:[],groups:[],arrays:{}}:Ki(a.slice(o?s[o-1]:0,s[o]).buffer);this.app.receive(l)})}showScans(){let t=new Wt,e=new R,n=[],s=[],r=[];this.recording.lidars.forEach((o,a)=>{let{[`lidar${a}.times`]:l,[`lidar${a}.poses`]:c,[`lidar${a}.ranges`]:d}=this.recording.arrays,h=l.findLastIndex(u=>u<=this.time+dA);if(!(h<0)){on(c,7*h,t),r.push(c[7*h],c[7*h+1],c[7*h+2]);for(let u=0;u<o.count;u++){let f=d[h*o.count+u]/1e3,p=o.low+u*o.step;f>0?s.push(...e.set(f*Math.cos(p),f*Math.sin(p),0).applyMatrix4(t)):s.push(NaN,NaN,NaN)}n.push([o.topic,o.count])}}),this.app.receive({kind:"lidar",lidars:n,arrays:{points:Float32Array.from(s),origins:Float32Array.from(r)}})}paths(t){let e={},n=[...this.app.scene.arrays.moving];for(let[s,r]of this.app.bodyOf){let o=7*n.indexOf(r),a=[];for(let l=0;l<this.times.length&&this.times[l]<=t;l++){let c=l*this.size+o,d=[...this.recording.arrays.poses.subarray(c,c+3)],h=a.at(-1);(!h||Math.hypot(d[0]-h[0],d[1]-h[1],d[2]-h[2])>.015)&&a.push(d)}e[s]=a}return e}};async function Bx(i){return window.simkitFile?Ki(window.simkitFile.recording):Ki(await(await i.fetch("recording")).arrayBuffer())}var Sp=[["0.1",.1],["0.25",.25],["0.5",.5],["1",1],["2",2],["5",5],["no limit",null]];function Vx(i,t){let e=(v,M,b,x)=>U("button",{id:v,title:b,"aria-label":b,onclick:x},M),n=e("play","\u275A\u275A","Pause or resume (space)",()=>kx(i)),s=U("input",{id:"count",type:"number",min:1,value:1,title:"Steps"}),r=e("step","\u25B6\u2758","Make steps and pause (n)",()=>zx(i,+s.value||1)),o=e("reset","\u27F2","Reset to the start",()=>i.send("reset")),a=U("select",{id:"speed",title:"Highest real-time factor",onchange:()=>i.send("pace",{value:Sp[a.selectedIndex][1]})},...Sp.map(([v])=>U("option",{},v==="no limit"?v:`${v} \xD7`))),l=U("select",{id:"viewpoint",title:"Viewpoint",onchange:()=>pA(i,l)}),c=U("span",{id:"time"}),d=U("span",{id:"rtf"}),h=U("span",{id:"link",class:"off"},"\u25CF connecting"),u=U("span"),f=U("span",{class:"more"}),p=U("span",{id:"frames"},u,f),_=U("strong",{id:"world"}),m=U("span",{id:"seed",class:"dim",title:"Seed of all random streams"});t.append(_,m,U("span",{class:"group"},n,r,s,o),a,c,d,U("span",{class:"space"}),l,e("tour-start","?","Tour of the page",()=>i.tour.start()),p,h),i.on("scene",v=>{_.textContent=v.world,m.textContent=`seed ${v.seed}`;let M=v.sensors.filter(Ml),b=[["","View \u2026"],["first","Robots"],["all","Everything"],["top","From above"],...i.robots.slice(0,40).map(x=>[`follow:${x.name}`,`Follow ${x.name}`]),...M.slice(0,40).map(x=>[`through:${x.name}`,`Through ${x.name.split("::").at(-1)}`])];l.replaceChildren(...b.map(([x,w])=>U("option",{value:x},w)))}),i.on("state",v=>{n.textContent=v.paused?"\u25B6":"\u275A\u275A",c.textContent=`${v.time.toFixed(v.paused?3:2)} s`,d.textContent=v.paused?"paused":`${v.rtf.toFixed(2)} \xD7 real time`;let M=Sp.findIndex(([,b])=>b===v.pace);document.activeElement!==a&&M>=0&&(a.selectedIndex=M)}),i.on("link",v=>{i.player||(h.textContent=v?"\u25CF live":"\u25CF ended",h.className=v?"on":"off",v||(d.textContent="no connection"))}),i.on("recording",v=>{h.textContent=`\u25CF recording ${v.recording.name}`,h.className="on"});let g=0,y=0,T=0;setInterval(()=>{if(document.hidden||!i.connection)return;let v=i.stage.draws-g;u.textContent=v||!i.player?`${v} frames/s`:"",f.textContent=(i.player?"":` \xB7 ${i.stats.states-y} states/s \xB7 ${((i.connection.bytes-T)/1024).toFixed(0)} KB/s`)+(i.stage.isSoftware?" \xB7 software":""),p.title=p.textContent,[g,y,T]=[i.stage.draws,i.stats.states,i.connection.bytes]},1e3),addEventListener("keydown",v=>{Jh(v)&&(v.key===" "?(v.preventDefault(),kx(i)):v.key==="n"?zx(i,1):v.key==="f"?fA(i):v.key==="h"&&i.views.first())})}function kx(i){i.send("pause",{value:!i.state?.paused})}async function zx(i,t){i.state?.paused||await i.send("pause",{value:!0}),i.send("step",{count:t})}function fA(i){if(i.views.followed!==null){i.views.follow(null);return}let t=i.selected?.split("::",1)[0]??i.robots[0]?.name;i.views.follow(i.bodyOf.get(t)??null)}function pA(i,t){let[e,...n]=t.value.split(":"),s=n.join(":");e==="follow"?i.views.follow(i.bodyOf.get(s)??null):e==="through"?i.views.through(i.scene.sensors.find(r=>r.name===s)):e&&i.views[e](),t.selectedIndex=0,t.blur()}var mA=[["#view","The scene","Drag to turn the view, drag with the right button or two fingers to move it, and use the wheel or two fingers to zoom. Click a link to select it."],["#toolbar .group","Run, step and reset","Pause and resume (space), make steps (n), or start again. The list beside the buttons limits the speed."],["#tree","Models and links","Select a model or a link here. The panel Models adds a model to the world, and moves, turns or deletes the selected one."],["#layers","What is drawn","Show lidars, contacts, frames, joint axes, centres of mass and more. Topics such as paths and maps have a list of their own."],["#drive, #joints","Move the robot","Drive with the pad or with the keys w a s d x. Sliders move the joints while the world is paused."],["#dock-tabs","Data","Plot any field of any topic, read the log, call services, send goals, set parameters, and draw the graph of nodes."]];function Gx(i){let t=U("h3"),e=U("p"),n=U("span",{class:"dim"}),s=(T,v,M)=>U("button",{id:T,onclick:M},v),r=s("tour-back","Back",()=>p(-1)),o=s("tour-next","Next",()=>p(1)),a=U("section",{id:"tour",role:"dialog","aria-label":"Tour of the page",hidden:!0},t,e,U("footer",{},n,s("tour-skip","Skip",()=>g()),r,o)),l=[],c=0,d=null,h=!0,u=([T])=>[...document.querySelectorAll(T)].find(v=>v.getClientRects().length),f=()=>{d&&(d.classList.remove("toured"),h||(d.open=!1),d=null)},p=T=>{if(c+T===l.length){g();return}f(),c+=T;let[,v,M]=l[c];d=u(l[c]),h=d.open!==!1,h||(d.open=!0),d.classList.add("toured"),d.scrollIntoView({block:"nearest"}),t.textContent=v,e.textContent=M,n.textContent=`${c+1} of ${l.length}`,o.textContent=c+1===l.length?"Done":"Next",r.disabled=c===0,a.className=_(d)},_=T=>{let v=T.getBoundingClientRect(),M=document.getElementById("view").getBoundingClientRect();return v.right<=M.left?"left":v.left>=M.right?"right":v.bottom<=M.top?"above":"below"},m=()=>{Br.matches&&i.openTab(null),f(),l=mA.filter(u),a.hidden=!1,c=0,p(0)},g=()=>{f(),a.hidden=!0,jh("tour","off")};addEventListener("keydown",T=>{T.key==="Escape"&&!a.hidden&&g()}),document.getElementById("view").append(a),i.tour={start:m};let y=!0;i.on("state",()=>{let T=y&&!i.player&&window.top===window;y=!1,T&&Kh("tour")!=="off"&&i.ask("targets").finally(m)})}var Mp=new Map,Lt={scene:null,state:null,models:new Map,robots:[],selected:null,stats:{states:0},on(i,t){Mp.set(i,[...Mp.get(i)??[],t])},emit(i,t){for(let e of Mp.get(i)??[])e(t)},select(i){Lt.selected=i,Lt.emit("select",i),Lt.stage.invalidate()},report(i){Ep(i)}};Lt.receive=i=>Ap(i);window.simkitView=Lt;var gA="The simulation has ended or cannot be reached. The page connects again when it can; a new run has a new address.",Hx,Nl="";function Ep(i){Fu(i),clearTimeout(Hx),Hx=setTimeout(()=>Fu(Nl),6e3)}function Fu(i){let t=document.getElementById("notice");i&&(t.textContent=i),t.hidden=!i}Fu("");function _A(i){let t=Nl;Nl=i||document.hidden||Lt.player?"":gA,Nl!==t&&Fu(Nl)}var xA=/^(state|appearance|joints)$|^display:/,bp=new Map;function Ap(i){if((i.kind==="scene_changed"||i.kind==="state")&&SA(i.revision),xA.test(i.kind)&&Cp()){bp.set(i.kind,i);return}i.kind==="state"?yA(i):i.kind==="appearance"&&vA(i),Lt.emit(`packet:${i.kind.split(":",1)[0]}`,i)}function yA(i){if(i.revision!==Lt.scene.revision)return;let t=Lt.state&&i.tick<Lt.state.tick;Lt.state=i,Lt.stats.states+=1,Lt.world.setPoses(i.arrays.poses),t&&Lt.layers.setPaths({}),Lt.layers.extendPaths(Lt.bodyOf),Lt.emit("state",i)}function vA(i){i.revision===Lt.scene.revision&&Lt.world.setAppearance(i.arrays)}var wp=!1,Tp=1,Cp=()=>(Lt.scene?.revision??0)<Tp;async function SA(i){if(Tp=Math.max(Tp,i),!wp){wp=!0;for(let t=0;Cp()&&t<20;t++)await Wx()||await new Promise(e=>setTimeout(e,500));wp=!1}}async function Wx(){try{let i=await Lt.connection.loadScene(),t=!Lt.scene;Lt.stage.setSurroundings(i.surroundings,i.arrays),await Lt.world.load(i),Lt.scene=i,Lt.models=new Map(i.models.map(e=>[e.name,e])),Lt.bodyOf=MA(i),Lt.robots=wA(i),Lt.layers.load(),Lt.emit("scene",i),document.title=`${i.world} \u2013 simkit`;for(let e of Cp()?[]:[...bp.values()])bp.delete(e.kind),Ap(e);i.recording&&t&&(Lt.player=Lt.connection.player=new Uu(Lt,await Bx(Lt.connection)),Lt.player.show(),Lt.emit("recording",Lt.player)),t&&Lt.views.first(),Lt.connection.ask("travel").then(e=>Lt.layers.setPaths(e)).catch(()=>{})}catch(i){return Ep(`the scene cannot be loaded: ${i.message}`),!1}return Lt.stage.invalidate(),!0}function MA(i){let t=new Set(i.arrays.moving),e=new Map;for(let[n,s]of i.frames){let r=n.split("::",1)[0];t.has(s)&&!e.has(r)&&e.set(r,s)}return e}function wA(i){let t=new Set([...i.joints,...i.sensors].map(s=>s.name.split("::",1)[0])),e=i.models.filter(s=>Lt.bodyOf.has(s.name)),n=e.filter(s=>t.has(s.name));return Lt.isRobot=s=>t.has(s),Lt.hasRobots=n.length>0,n.length?n:e}function bA(i){let t=null;i.addEventListener("pointerdown",e=>{t=[e.clientX,e.clientY],i.focus({preventScroll:!0})}),i.addEventListener("pointerup",e=>{if(!t||Math.hypot(e.clientX-t[0],e.clientY-t[1])>4||!Lt.scene)return;let n=Lt.pickAt(e.clientX,e.clientY);Lt.clickMode?Lt.clickMode(n,e):Lt.select(n&&!n.isFloor?n.link:null)})}Lt.pickAt=(i,t)=>{let e=Lt.stage.canvas.getBoundingClientRect(),n=new di;return n.setFromCamera(new Bt(2*(i-e.left)/e.width-1,1-2*(t-e.top)/e.height),Lt.stage.camera),Lt.world.pick(n)};Lt.groundAt=({clientX:i,clientY:t})=>{let e=Lt.stage.canvas.getBoundingClientRect(),n=new di;return n.setFromCamera(new Bt(2*(i-e.left)/e.width-1,1-2*(t-e.top)/e.height),Lt.stage.camera),n.ray.intersectPlane(new En(new R(0,0,1),0),new R)};try{Lt.on("link",_A),Lt.stage=new Du(document.getElementById("canvas"),new URLSearchParams(location.search).get("quality")??Kh("quality")??"auto"),Lt.world=new qh(Lt.stage),Lt.connection=new Vh(n=>{(!Lt.player||n.recorded)&&Ap(n)},Ep,n=>Lt.emit("link",n)),Lt.layers=new tu(Lt),Lt.views=new Nu(Lt),Lt.sensors=new eu(Lt),Lt.displays=new Zh(Lt),Lt.ask=(n,s)=>Lt.connection.ask(n,s),Lt.send=(n,s)=>Lt.connection.send(n,s),Vx(Lt,document.getElementById("toolbar"));for(let[n,s]of Fx){let r=s(Lt);r&&document.getElementById(n).append(r)}let i=["left","right"].map(n=>document.getElementById(n)),t=[...i[0].children],e=()=>i[Br.matches?1:0].append(...t);Br.addEventListener("change",e),e(),Gx(Lt),bA(Lt.stage.canvas),addEventListener("change",({target:n})=>{n.matches("select:not(:focus-visible)")&&n.blur()}),await Wx(),Lt.connection.open()}catch(i){throw document.getElementById("view").append(U("p",{class:"failure"},i.message)),i}
